#pragma once

#include <string>
#include <vector>

#include "compute/gl/egl_devices.h"

namespace spherule::compute::gl {

struct VisibleGpus {
    std::vector<const EglDevice*> devices;  // hardware, preferred first
    std::string note;                       // about the variable, for messages; empty if it has no effect
};

// Returns the hardware devices that `auto` and `gpu` may take. `variable`: the value of CUDA_VISIBLE_DEVICES, or
// nullptr. EGL itself ignores it. NVIDIA's devices whose CUDA numbers it lists remain, in its order,
// before devices of other vendors. As in CUDA, the first entry that is no number of a device ends the list. UUIDs have
// no effect, because EGL does not give them. If none of the listed numbers exists, and some NVIDIA devices have no CUDA
// number, the driver hides these by the variable, and counts the others anew: the others remain.
VisibleGpus visibleGpus(const std::vector<EglDevice>& devices, const char* variable);

}  // namespace spherule::compute::gl
