#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

namespace spherule {

// Passes at most one event in 10 s. Used by one thread.
class Throttle {
  public:
    using Clock = std::chrono::steady_clock;

    // Number of events suppressed since the last one that passed; nullopt if this one is suppressed too.
    std::optional<std::uint64_t> pass(Clock::time_point now) {
        if (last_ && now - *last_ < period) {
            ++suppressed_;
            return std::nullopt;
        }
        last_ = now;
        return std::exchange(suppressed_, 0);
    }

  private:
    static constexpr std::chrono::seconds period{10};
    std::optional<Clock::time_point> last_;
    std::uint64_t suppressed_ = 0;
};

}  // namespace spherule
