#pragma once

#include "compute/device.h"
#include "figures.h"

namespace spherule::bench {

// Measures the costs of a device that are the same for all scenes: launches of an empty kernel, one after the other,
// and copies. Only for OpenGL. `quick`: few launches and small copies.
Result<void> deviceCosts(compute::Device& device, bool quick, Figures& figures);

}  // namespace spherule::bench
