#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <utility>

namespace spherule::host {

// Measures how many states per second are shown, over the last two seconds. Used by one thread.
class RateMeter {
  public:
    using Clock = std::chrono::steady_clock;

    // Several chains may show the same version of the world, which counts once.
    void add(std::uint64_t version, Clock::time_point now) {
        if (std::exchange(version_, version) != version) times_.push_back(now);
    }
    [[nodiscard]] double perSecond(Clock::time_point now) {
        while (!times_.empty() && now - times_.front() > std::chrono::seconds(2)) times_.pop_front();
        if (times_.size() < 2) return 0;
        return static_cast<double>(times_.size() - 1) / std::chrono::duration<double>(now - times_.front()).count();
    }

  private:
    std::uint64_t version_ = 0;
    std::deque<Clock::time_point> times_;
};

}  // namespace spherule::host
