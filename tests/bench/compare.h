#pragma once

#include "compute/device.h"
#include "figures.h"
#include "stopwatch.h"

namespace spherule::bench {

struct Moments {
    double falling = 0.3;        // s simulated
    double settled = 2.5;        // s simulated
    double settledBudget = 240;  // wall time (s) after which the present state counts as settled
};

// Measures all methods from the same falling and the same settled state of a box of `spheres`. Adds one table per
// state, and tables that describe the states.
Result<void> compare(compute::Device& device, std::uint32_t spheres, const Moments& moments, const Effort& effort,
                     Figures& figures);

}  // namespace spherule::bench
