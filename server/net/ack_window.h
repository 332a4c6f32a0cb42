#pragma once

#include <chrono>
#include <cstdint>
#include <deque>

namespace spherule::net {

// Limits the frames that a client has not acknowledged. A browser reads from its socket even when it cannot keep up, so
// only its acks show the backlog. Used by one thread.
class AckWindow {
  public:
    using Clock = std::chrono::steady_clock;

    void setRate(std::uint32_t rate);  // frames per second

    void sent(std::uint64_t sequence, Clock::time_point now);
    void acked(std::uint64_t sequence);  // `sequence` and all before it

    // Returns true when another frame may be sent: unacknowledged frames span less than 1/4 s, the client never
    // acknowledges, or the last frame was sent more than 1 s ago.
    [[nodiscard]] bool open(Clock::time_point now) const;
    // Like open(), but only when no frame is unacknowledged (or the client does not acknowledge).
    [[nodiscard]] bool idle(Clock::time_point now) const;

  private:
    std::deque<std::uint64_t> unacknowledged_;  // sequence numbers, bounded when the client never acknowledges
    std::size_t limit_ = 3;
    bool clientAcks_ = false;
    Clock::time_point lastSent_{};
};

}  // namespace spherule::net
