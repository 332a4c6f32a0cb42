#include "diagnostics/auto_quality.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace spherule::diagnostics {

namespace {

constexpr int missesToAct = 3;
constexpr int easyToAct = 6;
constexpr double aim = 0.85;  // share of the goal that a change aims at
constexpr double mostChange = 2;

}  // namespace

bool AutoQuality::readable(const Reading& reading) const {
    return goal_.kind == scene::QualityGoal::Kind::StepTime ? reading.stepMs > 0 : reading.contacts > 0;
}

double AutoQuality::overGoal(const Reading& reading) const {
    return (goal_.kind == scene::QualityGoal::Kind::StepTime ? reading.stepMs : reading.overlapMean) / goal_.max;
}

// The step time is proportional to the substeps, the overlap to the inverse of their square.
std::uint32_t AutoQuality::wanted(double over, std::uint32_t substeps) const {
    const bool time = goal_.kind == scene::QualityGoal::Kind::StepTime;
    const double right = time ? aim / over : std::sqrt(over / aim);
    const double exact = substeps * std::clamp(right, 1 / mostChange, mostChange);
    const double whole = time ? std::floor(exact) : std::ceil(exact);
    return static_cast<std::uint32_t>(std::clamp<double>(whole, range_.fewest, range_.most));
}

std::string AutoQuality::describe(const Reading& reading) const {
    if (goal_.kind == scene::QualityGoal::Kind::StepTime)
        return fmt::format("a step takes {:.3g} ms, and may take {:.3g}", reading.stepMs, goal_.max);
    return fmt::format("the mean overlap is {:.2g} % of the radius, and may be {:.2g}", 100 * reading.overlapMean,
                       100 * goal_.max);
}

std::optional<Decision> AutoQuality::take(const Reading& reading, std::uint32_t substeps) {
    if (!readable(reading)) return std::nullopt;
    const bool time = goal_.kind == scene::QualityGoal::Kind::StepTime;
    const double easyBelow = time ? 0.6 : 0.4;
    const double over = overGoal(reading);
    missed_ = over > 1 ? missed_ + 1 : 0;
    easy_ = over < easyBelow ? easy_ + 1 : 0;
    if (missed_ < missesToAct && easy_ < easyToAct) return std::nullopt;
    const bool missing = missed_ >= missesToAct;
    missed_ = 0;
    easy_ = 0;
    const std::uint32_t next = wanted(over, substeps);
    // A step time beyond its goal needs fewer substeps, an overlap beyond its goal more. Far below the goal, substeps
    // change in the other direction.
    const bool down = time == missing;
    if (down ? next < substeps : next > substeps) {
        gaveUp_ = false;
        return Decision{next,
                        fmt::format("{} substeps per step in place of {}: {}", next, substeps, describe(reading))};
    }
    if (!missing || gaveUp_) return std::nullopt;
    gaveUp_ = true;
    return Decision{substeps, fmt::format("the goal is out of reach even with {} substeps per step: {}", substeps,
                                          describe(reading))};
}

}  // namespace spherule::diagnostics
