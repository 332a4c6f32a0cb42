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

// The largest error of a division, over the error of a processor (0.5 ulp). GLSL allows GPUs 2.5 ulp, and perturbed
// arithmetic has 2 ulp.
inline unsigned errorOfDivisions() {
    const bool exact = testDevice().starts_with("cpu") || testDevice().starts_with("software");
    return exact && std::getenv("SPHERULE_PERTURBED_SEED") == nullptr ? 1 : 4;
}

inline std::unique_ptr<compute::Device> openTestDevice() {
    return valueOf(compute::openDevice(testDevice()));
}

}  // namespace spherule::support
