#include "measure/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spherule::measure {

namespace {

double energyOf(const sim::Statistics& s) {
    return s.kineticEnergy + s.rotationalEnergy + s.elasticEnergy + s.potentialEnergy;
}

// Returns the present failure; empty if there is none.
std::string troubleIn(const sim::Statistics& s, double rise, double time, const Limits& limits) {
    if (s.nonFinite > 0) return fmt::format("fails: {} not finite after {:.3g} s", s.nonFinite, time);
    if (s.outside > 0) return fmt::format("fails: {} outside the bounds after {:.3g} s", s.outside, time);
    if (rise > limits.energyRise) return fmt::format("fails: energy up by {:.3g} after {:.3g} s", rise, time);
    return "";
}

}  // namespace

Result<void> survive(Bench& bench, sim::Simulation& simulation, const std::string& name, double seconds,
                     const Limits& limits) {
    constexpr long looks = 20;
    const long most = bench.quick() ? 4'000 : 40'000;  // substeps
    const long affordable = std::max<long>(1, most / simulation.scene().quality.substeps);
    const long steps = std::clamp(std::lround(seconds / simulation.scene().step), 1L, affordable);
    const double start = energyOf(simulation.statistics());
    double rise = 0;
    std::string trouble;
    for (long k = 1; k <= steps; ++k) {
        if (auto done = bench.step(simulation); !done) return done;
        if (k % std::max(1L, steps / looks) != 0 && k != steps) continue;
        const sim::Statistics s = simulation.statistics();
        if (start > 0) rise = std::max(rise, energyOf(s) / start - 1);
        if (trouble.empty()) trouble = troubleIn(s, rise, simulation.time(), limits);
    }
    const double overlap = simulation.statistics().overlapMax;
    if (trouble.empty() && overlap > limits.overlap)
        trouble = fmt::format("fails: overlap of {:.3g} r at the end", overlap);
    if (trouble.empty() && std::isnan(rise)) trouble = "fails: energy is not a number";
    Figure figure = plain(name, rise, "of the energy");
    figure.verdict = trouble.empty() ? "pass" : trouble;
    bench.add(std::move(figure));
    if (limits.overlap < std::numeric_limits<double>::infinity())
        bench.add(plain(name + ": overlap at the end", overlap, "of r"));
    return {};
}

}  // namespace spherule::measure
