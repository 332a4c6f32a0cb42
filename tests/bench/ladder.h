#pragma once

#include "compute/device.h"
#include "figures.h"

namespace spherule::bench {

// Ours by pass at one size, from two states that cost little to reach at any size: the falling box after `steps` steps,
// and a dense packing one step after it was let go. Medians of `rounds` rounds of 24 substeps each.
Result<void> climb(compute::Device& device, std::uint32_t spheres, unsigned steps, unsigned rounds, Figures& figures);

// Largest over smallest cost per sphere between the sizes, per state; empty where there are none.
std::string spreadOf(const Figures& figures);

}  // namespace spherule::bench
