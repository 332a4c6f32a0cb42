#pragma once

#include <string>
#include <vector>

#include <glad/egl.h>

namespace spherule::compute::gl {

// In the order in which we prefer them.
enum class EglDeviceClass { Cuda, Drm, OtherHardware, Software };

struct EglDevice {
    EGLDeviceEXT handle = nullptr;
    unsigned index = 0;  // in EGL's order
    EglDeviceClass deviceClass = EglDeviceClass::OtherHardware;
    std::string name;  // by EGL_EXT_device_query_name, else empty
    std::string extensions;
    std::string drmFile;  // "/dev/dri/card0"; empty when the device has none

    [[nodiscard]] bool software() const { return deviceClass == EglDeviceClass::Software; }
};

// The host's EGL devices, preferred first, each logged at debug level; empty when EGL cannot list them. `loadEgl` came
// before. Any thread.
std::vector<EglDevice> eglDevices();

}  // namespace spherule::compute::gl
