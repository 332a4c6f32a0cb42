#pragma once

#include "compute/device.h"
#include "figures.h"
#include "stopwatch.h"

namespace spherule::bench {

struct Moments {
    double falling = 0.3;        // s simulated
    double settled = 2.5;        // s simulated,
    double settledBudget = 240;  // unless it takes longer than this, in s; the state is then the one reached
};

// All methods from the same falling and the same settled state of a box of `spheres`, in one table per state; and what
// these states are.
Result<void> compare(compute::Device& device, std::uint32_t spheres, const Moments& moments, const Effort& effort,
                     Figures& figures);

}  // namespace spherule::bench
