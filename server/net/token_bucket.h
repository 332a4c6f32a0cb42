#pragma once

#include <algorithm>
#include <chrono>

namespace spherule::net {

// So many events a second on average, and at most a second's worth at once. One thread.
class TokenBucket {
  public:
    using Clock = std::chrono::steady_clock;

    // `rate` in events per second; 0: any number.
    TokenBucket(double rate, Clock::time_point now) : rate_(rate), level_(burst()), filled_(now) {}

    // Whether take() would be true.
    [[nodiscard]] bool has(Clock::time_point now) const { return rate_ <= 0 || levelAt(now) >= 1; }

    // False where the event is one too many.
    [[nodiscard]] bool take(Clock::time_point now) {
        if (rate_ <= 0) return true;
        level_ = levelAt(now);
        filled_ = now;
        if (level_ < 1) return false;
        level_ -= 1;
        return true;
    }

    // As if nothing had ever been taken.
    [[nodiscard]] bool full(Clock::time_point now) const { return levelAt(now) >= burst(); }

  private:
    [[nodiscard]] double burst() const { return std::max(rate_, 1.0); }
    [[nodiscard]] double levelAt(Clock::time_point now) const {
        return std::min(burst(), level_ + rate_ * std::chrono::duration<double>(now - filled_).count());
    }

    double rate_;
    double level_;
    Clock::time_point filled_;
};

}  // namespace spherule::net
