#pragma once

#include <span>
#include <string>
#include <vector>

#include "method.h"

namespace spherule::bench {

// Largest number of substeps before the state is restored: 0.05 s, in which a fall or a bed hardly changes.
constexpr unsigned mostSubsteps = 24;

struct Effort {
    unsigned rounds = 5;        // per method; 3 if a substep takes over 2 s, a single substep if over 30 s
    double roundSeconds = 0.5;  // approximate duration of a round of one method
};

struct Timing {
    double seconds = 0;   // median wall time of a substep
    unsigned rounds = 0;  // number of rounds in the median
};

double median(std::vector<double> values);

// Returns the wall time (s) of `substeps` substeps from `state`, until the device is idle.
double timeSubsteps(compute::Device& device, Method& method, const sim::State& state, unsigned substeps);

// Measures the methods in turns, so that a change of the machine's load affects all of them.
std::vector<Timing> race(compute::Device& device, std::span<Method* const> methods, const sim::State& state,
                         const Effort& effort);

}  // namespace spherule::bench
