#pragma once

#include "compute/probe.h"

namespace spherule::compute::gl {

// Of the current context.
Limits queryLimits();

}  // namespace spherule::compute::gl
