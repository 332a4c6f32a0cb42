#pragma once

#include <cstdlib>
#include <memory>

#include "compute/device.h"
#include "value_of.h"

namespace spherule::support {

// Opens the device named by SPHERULE_TEST_DEVICE. The default is Mesa's software renderer, which runs everywhere.
inline std::unique_ptr<compute::Device> openTestDevice() {
    const char* const named = std::getenv("SPHERULE_TEST_DEVICE");
    return valueOf(compute::openDevice(named == nullptr ? "software" : named));
}

}  // namespace spherule::support
