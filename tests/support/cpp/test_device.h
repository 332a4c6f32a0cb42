#pragma once

#include <cstdlib>
#include <memory>
#include <string>

#include "compute/device.h"
#include "value_of.h"

namespace spherule::support {

// SPHERULE_TEST_DEVICE. The default is Mesa's software renderer, which runs everywhere.
inline std::string testDevice() {
    const char* const named = std::getenv("SPHERULE_TEST_DEVICE");
    return named == nullptr ? "software" : named;
}

inline std::unique_ptr<compute::Device> openTestDevice() {
    return valueOf(compute::openDevice(testDevice()));
}

}  // namespace spherule::support
