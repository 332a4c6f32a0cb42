#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

namespace spherule {

// Lets one of many alike through in ten seconds. One thread.
class Throttle {
  public:
    using Clock = std::chrono::steady_clock;

    // How many were held back since the last that came through; nothing: so is this one.
    std::optional<std::uint64_t> pass(Clock::time_point now) {
        if (last_ && now - *last_ < period) {
            ++held_;
            return std::nullopt;
        }
        last_ = now;
        return std::exchange(held_, 0);
    }

  private:
    static constexpr std::chrono::seconds period{10};
    std::optional<Clock::time_point> last_;
    std::uint64_t held_ = 0;
};

}  // namespace spherule
