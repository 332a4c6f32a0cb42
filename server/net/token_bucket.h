#pragma once

#include <algorithm>
#include <chrono>

namespace spherule::net {

// Limits events to a rate, with bursts of at most the events of one second. Used by one thread.
class TokenBucket {
  public:
    using Clock = std::chrono::steady_clock;

    // `rate` (events/s); 0: no limit.
    TokenBucket(double rate, Clock::time_point now) : rate_(rate), level_(burst()), filled_(now) {}

    // Returns true when take() would return true.
    [[nodiscard]] bool has(Clock::time_point now) const { return rate_ <= 0 || levelAt(now) >= 1; }

    // Counts an event; returns false when it exceeds the rate.
    [[nodiscard]] bool take(Clock::time_point now) {
        if (rate_ <= 0) return true;
        level_ = levelAt(now);
        filled_ = now;
        if (level_ < 1) return false;
        level_ -= 1;
        return true;
    }

    // Returns true when the bucket has recovered from all events.
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
