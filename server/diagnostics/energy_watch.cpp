#include "diagnostics/energy_watch.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace spherule::diagnostics {

namespace {

constexpr std::size_t several = 5;
constexpr std::size_t quietReadings = 10;
constexpr double tolerated = 0.01;  // tolerated rise / energy

}  // namespace

std::optional<std::string> EnergyWatch::check(const Reading& reading) {
    const double energy = reading.kinetic + reading.elastic + reading.potential - reading.given;
    if (!std::isfinite(energy)) return std::nullopt;
    // Far below the bounds, and near a centre of attraction, potential energy is negative; the plain sum would be too
    // small as a scale.
    const double scale =
        reading.kinetic + reading.elastic + std::abs(reading.potential - reading.fields) + std::abs(reading.fields);
    std::optional<std::string> alarm;
    if (!recent_.empty()) {
        const double highest = std::ranges::max_element(recent_, {}, &Seen::energy)->energy;
        if (recent_.size() == several) ceiling_ = std::min(ceiling_.value_or(highest), highest);
        const double before = ceiling_.value_or(highest);
        const bool soft = reading.soft || std::ranges::any_of(recent_, &Seen::soft);
        const bool enough = !soft || recent_.size() == several;
        if (enough && energy - before > tolerated * scale) {
            if (!alarmed_)
                alarm = fmt::format(
                    "at step {}, mechanical energy has risen by {:.3g} J to {:.3g} J, though nothing gave any: the "
                    "model is "
                    "beyond its range here; use more substeps or another model",
                    reading.step, energy - before, reading.kinetic + reading.elastic + reading.potential);
            alarmed_ = true;
            invalidateBaseline();
        } else if (alarmed_ && ++quiet_ >= quietReadings) {
            alarmed_ = false;
        }
    }
    recent_.push_back({energy, reading.soft});
    if (recent_.size() > several) recent_.pop_front();
    return alarm;
}

void EnergyWatch::invalidateBaseline() {
    recent_.clear();
    ceiling_.reset();
    quiet_ = 0;
}

}  // namespace spherule::diagnostics
