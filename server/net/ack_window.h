#pragma once

#include <chrono>
#include <cstdint>
#include <deque>

namespace spherule::net {

// How many frames a client has not acknowledged. A browser takes what comes in even where it cannot keep up with it, so
// that only acks tell. One thread.
class AckWindow {
  public:
    using Clock = std::chrono::steady_clock;

    void setRate(std::uint32_t rate);  // frames per second

    void sent(std::uint64_t sequence, Clock::time_point now);
    void acked(std::uint64_t sequence);  // and all before it

    // Whether another frame may go: fewer than a quarter of a second's are on their way, or the client never says, or
    // has not said for so long that it may have expiry.
    [[nodiscard]] bool open(Clock::time_point now) const;
    // The same of none on its way.
    [[nodiscard]] bool idle(Clock::time_point now) const;

  private:
    std::deque<std::uint64_t> unacknowledged_;  // sequences, bounded while the client never acks
    std::size_t limit_ = 3;
    bool clientAcks_ = false;
    Clock::time_point lastSent_{};  // one was sent
};

}  // namespace spherule::net
