#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "net/session_id.h"
#include "spherule/v1/control.pb.h"

namespace spherule::net {

// The controls, which one controller has at a time: taken while they are free, handed over by their holder, free again
// when the holder leaves. Knows nothing of roles. On the io thread.
class ControlLock {
  public:
    // `tell` is called with each change.
    explicit ControlLock(std::function<void(const v1::Control&)> notify) : notify_(std::move(notify)) {}

    // Who gives a command takes the controls if they are free; false where somebody else has them.
    bool acquire(SessionId session, const std::string& client);
    // Takes them if they are free, or waits for the holder's word.
    void request(SessionId session, const std::string& client);
    // The holder gives them to one who asks, with 0 to the first of those, or to nobody. One who asks does so no
    // longer.
    void release(SessionId session, SessionId to);
    // The holder keeps them: nobody asks any more.
    void denyRequests(SessionId session);
    void onSessionEnded(SessionId session);  // its holder's last word, as it were: whoever asks gets them

    [[nodiscard]] const v1::Control& state() const { return state_; }

  private:
    [[nodiscard]] bool holds(SessionId session) const;
    [[nodiscard]] int requestIndex(SessionId session) const;  // place in the row, or -1
    void grant(SessionId session, const std::string& client);
    void passOn();
    void notify() const { notify_(state_); }

    std::function<void(const v1::Control&)> notify_;
    v1::Control state_;
};

}  // namespace spherule::net
