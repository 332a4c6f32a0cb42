#pragma once

#include <vector>

#include "compute/device.h"
#include "scene/features.h"

namespace spherule::sim {

// The kernels that come with the program.
const compute::SourceSet& shaders();

// What the kernels ask with HAS(...).
std::vector<compute::Define> definesFor(const scene::Features& features);

}  // namespace spherule::sim
