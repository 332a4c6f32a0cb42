#include "host/step_scheduler.h"

#include <fmt/format.h>

#include <algorithm>

namespace spherule::host {

namespace {

using namespace std::chrono_literals;
// Late steps are made up for, up to this lag. Beyond it, the simulation runs slower than requested.
constexpr auto mostLag = 50ms;
constexpr auto window = 2s;
constexpr std::size_t mostRecent = 4096;

constexpr double slowest = 0.001;
constexpr double fastest = 1000;
constexpr std::uint32_t mostSteps = 100'000;

}  // namespace

Result<void> checkSpeed(double speed) {
    if (speed >= slowest && speed <= fastest) return {};
    return fail(ErrorKind::Refused, "speed",
                fmt::format("is {:g}, must be within {:g} and {:g}", speed, slowest, fastest), Cause::Range,
                {.least = slowest, .most = fastest});
}

Result<void> checkStepCount(std::uint32_t count) {
    if (count >= 1 && count <= mostSteps) return {};
    return fail(ErrorKind::Refused, "count", fmt::format("is {}, must be within 1 and {}", count, mostSteps),
                Cause::Range, {.least = 1, .most = mostSteps});
}

void StepScheduler::setSpeed(double speed) {
    speed_ = speed;
    due_ = Clock::now();
}

StepScheduler::Clock::duration StepScheduler::untilDue(Clock::time_point now) const {
    return std::max(due_ - now, Clock::duration{});
}

void StepScheduler::stepped(Clock::time_point now) {
    const auto interval = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(step_ / speed_));
    due_ = std::max(due_ + interval, now - mostLag);
    recent_.push_back(now);
    while (recent_.size() > mostRecent || (recent_.size() > 2 && now - recent_.front() > window)) recent_.pop_front();
}

void StepScheduler::resume(Clock::time_point now) {
    due_ = now;
    recent_.clear();
}

double StepScheduler::stepsPerSecond(Clock::time_point now) const {
    if (recent_.size() < 2) return 0;
    const double span = std::chrono::duration<double>(std::max(now, recent_.back()) - recent_.front()).count();
    return span > 0 ? static_cast<double>(recent_.size() - 1) / span : 0;
}

double StepScheduler::realTimeFactor(Clock::time_point now) const {
    return stepsPerSecond(now) * step_;
}

}  // namespace spherule::host
