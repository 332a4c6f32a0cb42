#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glad/egl.h>

namespace spherule::compute::gl {

// Classes in order of preference.
enum class EglDeviceClass { Cuda, Drm, OtherHardware, Software };

struct EglDevice {
    EGLDeviceEXT handle = nullptr;
    unsigned index = 0;  // in EGL's order
    EglDeviceClass deviceClass = EglDeviceClass::OtherHardware;
    std::string name;  // by EGL_EXT_device_query_name; empty without it
    std::string extensions;
    std::string drmFile;                 // "/dev/dri/card0"; empty if the device has none
    std::optional<unsigned> cudaNumber;  // of NVIDIA's devices, as CUDA counts them

    [[nodiscard]] bool software() const { return deviceClass == EglDeviceClass::Software; }
};

// Returns the host's EGL devices, preferred first, and logs each at debug level. Empty if EGL cannot list devices. Call
// loadEgl() first. Any thread.
std::vector<EglDevice> eglDevices();

}  // namespace spherule::compute::gl
