#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compute/device.h"
#include "sim/simulation.h"

namespace spherule::cli {

// Times and figures of an interval of a run.
struct Interval {
    double simSeconds = 0;
    double wallSeconds = 0;
    std::vector<double> passSeconds;  // device time (s), by sim::Pass
    std::uint64_t rebuilds = 0;       // of the pair lists
    std::uint64_t launches = 0;       // of kernels
    sim::Impacts before;              // impacts observed before the interval
    sim::Statistics end{};            // statistics at the end of the interval
};

// The line that `run --json` prints. It always has every key. Its state is the state at the end of the interval.
std::string runJson(const compute::DeviceInfo& device, sim::Simulation& simulation, const Interval& interval);

// The same figures as text for people.
std::string runText(const compute::DeviceInfo& device, sim::Simulation& simulation, const Interval& interval);

// A table with one row for each interval, and its header.
extern const char* const runRowHeader;
std::string runRow(sim::Simulation& simulation, const Interval& interval);

}  // namespace spherule::cli
