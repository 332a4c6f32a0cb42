#pragma once

#include <memory>
#include <string>

#include "compute/device.h"

namespace spherule::compute::gl {

// Opens "auto" (a hardware GPU), "gpu", "gpu:N", "gpu:cuda:N" or "software". Input for anything else, NoDevice if there
// is no such device.
Result<std::unique_ptr<Device>> openDevice(const std::string& choice);

}  // namespace spherule::compute::gl
