#pragma once

#include <string>

#include "compute/device.h"
#include "sim/simulation.h"

namespace spherule::app {

struct RunTimes {
    double wallSeconds = 0;
    double deviceSeconds = 0;  // sum of the passes
};

// The line that `run --json` prints: every key, always.
std::string runJson(const compute::DeviceInfo& device, sim::Simulation& simulation, const RunTimes& times);

// The same for people.
std::string runText(const compute::DeviceInfo& device, sim::Simulation& simulation, const RunTimes& times);

}  // namespace spherule::app
