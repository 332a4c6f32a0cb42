#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "spherule/v1/control.pb.h"

namespace spherule::net {

// The controls, which one controller has at a time: taken while they are free, handed over by their holder, free again
// when the holder leaves. Knows nothing of roles. On the io thread.
class Lease {
  public:
    using SessionId = std::uint64_t;

    // `tell` is called with each change.
    explicit Lease(std::function<void(const v1::Control&)> tell) : tell_(std::move(tell)) {}

    // Who gives a command takes the controls if they are free; false where somebody else has them.
    bool take(SessionId session, const std::string& client);
    // Takes them if they are free, or waits for the holder's word.
    void ask(SessionId session, const std::string& client);
    // The holder gives them to one who asks, with 0 to the first of those, or to nobody. One who asks does so no
    // longer.
    void yield(SessionId session, SessionId to);
    // The holder keeps them: nobody asks any more.
    void retain(SessionId session);
    void left(SessionId session);  // its holder's last word, as it were: whoever asks gets them

    [[nodiscard]] const v1::Control& state() const { return state_; }

  private:
    [[nodiscard]] bool holds(SessionId session) const;
    [[nodiscard]] int asking(SessionId session) const;  // place in the row, or -1
    void give(SessionId session, const std::string& client);
    void pass();
    void tell() const { tell_(state_); }

    std::function<void(const v1::Control&)> tell_;
    v1::Control state_;
};

}  // namespace spherule::net
