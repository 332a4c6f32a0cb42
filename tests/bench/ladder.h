#pragma once

#include <span>

#include "compute/device.h"
#include "figures.h"

namespace spherule::bench {

// Ours by pass at several sizes, one step after the spheres were let go from the arrangements `falling` and `dense`,
// which cost little to reach at any size. Medians of `rounds` rounds of 24 substeps each, fewer where they take
// seconds; the sizes take turns, so that a change of the machine's load meets all of them.
Result<void> climb(compute::Device& device, std::span<const std::uint32_t> sizes, unsigned rounds, Figures& figures);

// Largest over smallest cost per sphere between the sizes, per state; empty where there are none.
std::string spreadOf(const Figures& figures);

}  // namespace spherule::bench
