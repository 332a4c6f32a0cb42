#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compute/device.h"
#include "sim/simulation.h"

namespace spherule::app {

// Times and figures of a stretch of a run.
struct Stretch {
    double simSeconds = 0;
    double wallSeconds = 0;
    std::vector<double> passSeconds;  // device time (s), by sim::Pass
    std::uint64_t rebuilds = 0;       // of the pair lists
    sim::Impacts before;              // impacts observed before the stretch
    sim::Statistics end{};            // statistics at the end of the stretch
};

// The line that `run --json` prints. It always has every key. Its state is the state at the end of the stretch.
std::string runJson(const compute::DeviceInfo& device, sim::Simulation& simulation, const Stretch& stretch);

// The same figures as text for people.
std::string runText(const compute::DeviceInfo& device, sim::Simulation& simulation, const Stretch& stretch);

// A table with one row for each stretch, and its header.
extern const char* const runRowHeader;
std::string runRow(sim::Simulation& simulation, const Stretch& stretch);

}  // namespace spherule::app
