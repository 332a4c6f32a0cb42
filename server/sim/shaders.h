#pragma once

#include "compute/device.h"

namespace spherule::sim {

// The kernels that come with the program.
const compute::SourceSet& shaders();

}  // namespace spherule::sim
