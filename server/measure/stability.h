#pragma once

#include <limits>
#include <string>

#include "measure/bench.h"

namespace spherule::measure {

struct Limits {
    double energyRise = 0.01;                                  // of the energy at the start
    double overlap = std::numeric_limits<double>::infinity();  // of the smaller radius, at the end
};

// Runs for `seconds`, or less if that would take too many substeps, and reads the state about twenty times. Adds the
// figure `name`: the largest rise of the energy, with the verdict "pass" or the first failure.
Result<void> survive(Bench& bench, sim::Simulation& simulation, const std::string& name, double seconds,
                     const Limits& limits = {});

}  // namespace spherule::measure
