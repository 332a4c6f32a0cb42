#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compute/device.h"
#include "sim/simulation.h"

namespace spherule::app {

// What a stretch of a run took.
struct Stretch {
    double simSeconds = 0;
    double wallSeconds = 0;
    std::vector<double> passSeconds;  // device time by sim::Pass
    std::uint64_t rebuilds = 0;       // of the pair lists
    sim::Impacts before;              // those observed before it
    sim::Statistics end{};            // of the state at its end
};

// The line that `run --json` prints: every key, always. The state is that at the end of the stretch.
std::string runJson(const compute::DeviceInfo& device, sim::Simulation& simulation, const Stretch& stretch);

// The same for people.
std::string runText(const compute::DeviceInfo& device, sim::Simulation& simulation, const Stretch& stretch);

// One row for each of many stretches, and what its columns are.
extern const char* const runRowHeader;
std::string runRow(sim::Simulation& simulation, const Stretch& stretch);

}  // namespace spherule::app
