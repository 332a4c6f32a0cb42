#pragma once

#include <span>
#include <string>
#include <vector>

#include "method.h"

namespace spherule::bench {

// Most substeps from one state before it is put back: 0.05 s, in which neither a fall nor a bed changes its nature.
constexpr unsigned mostSubsteps = 24;

struct Effort {
    unsigned rounds = 5;  // of every method in turn; those with substeps over 2 s do 3, over 30 s only one substep
    double roundSeconds = 0.5;  // of one method, about
};

struct Timing {
    double seconds = 0;   // per substep, wall, median
    unsigned rounds = 0;  // that it is the median of
};

double median(std::vector<double> values);

// Wall seconds of `substeps` substeps from `state`, until the device is idle.
double timeSubsteps(compute::Device& device, Method& method, const sim::State& state, unsigned substeps);

// Each method, measured in turns so that a change of the machine's load meets all of them.
std::vector<Timing> race(compute::Device& device, std::span<Method* const> methods, const sim::State& state,
                         const Effort& effort);

}  // namespace spherule::bench
