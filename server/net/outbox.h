#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "frame/message.h"

namespace spherule::net {

// What one session still has to send, in two lanes: a reliable one that is bounded, and one place for a state frame,
// where the newest wins. A state goes out only after the scene facts of its epoch. One thread.
class Outbox {
  public:
    using Clock = std::chrono::steady_clock;

    // `capacity` messages in the reliable lane; `rate` state frames per second at most, 0 for none.
    Outbox(std::size_t capacity, std::uint32_t rate);

    void setRate(std::uint32_t rate);

    // False when the lane is full. Scene facts, settings, dials and diagnostics take the place of older ones that wait.
    [[nodiscard]] bool push(frame::SharedMessage message);
    // True when it replaced a frame that was due.
    bool offer(frame::SharedMessage frame, Clock::time_point now);

    // The next message to send, the reliable lane first; nothing while there is none or the frame may not go yet.
    frame::SharedMessage next(Clock::time_point now);
    // When to ask again; nothing while there is no frame or its facts have not come.
    [[nodiscard]] std::optional<Clock::time_point> frameDue() const;

    void dropFrame() { frame_.reset(); }
    void clear();

  private:
    [[nodiscard]] bool frameIsDescribed() const;

    const std::size_t capacity_;
    std::uint32_t rate_;
    std::optional<std::uint32_t> epoch_;  // of the latest facts
    std::deque<frame::SharedMessage> reliable_;
    frame::SharedMessage frame_;
    Clock::time_point due_{};
};

}  // namespace spherule::net
