#pragma once

#include <span>

#include "compute/device.h"
#include "figures.h"

namespace spherule::bench {

// Measures the passes of our simulation for several numbers of spheres, one step after the arrangements `falling` and
// `dense`, which take little time to reach, with a coefficient of friction. Adds medians of `rounds` rounds of 24
// substeps, or of fewer rounds if these take seconds. The sizes take turns, so that a change of the machine's load
// affects all of them.
Result<void> climb(compute::Device& device, std::span<const std::uint32_t> sizes, double friction, unsigned rounds,
                   Figures& figures);

// Returns, per state, the largest cost per sphere of all sizes divided by the smallest; empty without figures.
std::string spreadOf(const Figures& figures);

}  // namespace spherule::bench
