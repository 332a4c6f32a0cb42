#pragma once

#include "compute/probe.h"

namespace spherule::compute::gl {

// Returns the limits of the current context.
Limits queryLimits();

}  // namespace spherule::compute::gl
