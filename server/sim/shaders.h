#pragma once

#include "compute/device.h"

namespace spherule::sim {

// Returns the sources of the kernels that are part of the program.
const compute::SourceSet& shaders();

}  // namespace spherule::sim
