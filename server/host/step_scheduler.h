#pragma once

#include <chrono>
#include <cstdint>
#include <deque>

#include "core/result.h"

namespace spherule::host {

// Refused if the speed, or the number of steps of one command, is out of range.
Result<void> checkSpeed(double speed);
Result<void> checkStepCount(std::uint32_t count);

// Decides when the next step is due, and measures the real speed of the simulation. When the machine cannot keep up,
// simulated time slows down: only a few late steps are made up for. Used by one thread.
class StepScheduler {
  public:
    using Clock = std::chrono::steady_clock;

    void setStep(double seconds) { step_ = seconds; }
    void setSpeed(double speed);  // simulated seconds per wall second
    [[nodiscard]] double speed() const { return speed_; }

    // Time until the next step; zero when it is due.
    [[nodiscard]] Clock::duration untilDue(Clock::time_point now) const;
    void stepped(Clock::time_point now);
    void resume(Clock::time_point now);  // after a pause: the next step is due at once, and earlier steps do not count

    [[nodiscard]] double realTimeFactor(Clock::time_point now) const;
    [[nodiscard]] double stepsPerSecond(Clock::time_point now) const;

  private:
    double step_ = 1.0 / 60;
    double speed_ = 1;
    Clock::time_point due_ = Clock::now();
    std::deque<Clock::time_point> recent_;  // times of the recent steps
};

}  // namespace spherule::host
