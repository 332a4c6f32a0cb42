#pragma once

#include <cstdint>
#include <deque>

namespace spherule::net {

// How many frames a client has not acknowledged. A browser takes what comes in even where it cannot keep up with it, so
// that only acks tell. One thread.
class Credit {
  public:
    void setRate(std::uint32_t rate);  // frames per second

    void sent(std::uint64_t sequence);
    void acked(std::uint64_t sequence);  // and all before it

    // Whether another frame may go: fewer than a quarter of a second's are on their way, or the client never says.
    [[nodiscard]] bool open() const;
    // Whether none is on its way, or the client never says.
    [[nodiscard]] bool idle() const { return !acks_ || underWay_.empty(); }

  private:
    std::deque<std::uint64_t> underWay_;  // sequences, bounded while the client never acks
    std::size_t most_ = 3;
    bool acks_ = false;
};

}  // namespace spherule::net
