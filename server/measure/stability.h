#pragma once

#include <limits>
#include <string>

#include "measure/bench.h"

namespace spherule::measure {

struct Limits {
    double energyRise = 0.01;                                  // of the energy at the start
    double overlap = std::numeric_limits<double>::infinity();  // of the smaller radius, at the end
};

// Runs for `seconds`, or for fewer where that would take too many substeps, looks at the spheres some twenty times and
// adds the figure `name`: the largest rise of the energy, and as the verdict "pass" or what went wrong first.
Result<void> survive(Bench& bench, sim::Simulation& simulation, const std::string& name, double seconds,
                     const Limits& limits = {});

}  // namespace spherule::measure
