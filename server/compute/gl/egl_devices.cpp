#include "compute/gl/egl_devices.h"

#include <algorithm>

#include <spdlog/fmt/fmt.h>

#include "compute/gl/egl_api.h"
#include "core/log.h"

namespace spherule::compute::gl {
namespace {

std::string deviceString(EGLDeviceEXT device, EGLint name) {
    const char* const text = eglQueryDeviceStringEXT(device, name);
    if (text == nullptr) eglGetError();
    return text == nullptr ? std::string() : text;
}

EglDeviceClass classify(const std::string& extensions) {
    if (hasExtension(extensions, "EGL_MESA_device_software")) return EglDeviceClass::Software;
    if (hasExtension(extensions, "EGL_NV_device_cuda")) return EglDeviceClass::Cuda;
    if (hasExtension(extensions, "EGL_EXT_device_drm")) return EglDeviceClass::Drm;
    return EglDeviceClass::OtherHardware;
}

std::optional<unsigned> cudaNumber(EGLDeviceEXT device, const std::string& extensions) {
    if (!hasExtension(extensions, "EGL_NV_device_cuda") || eglQueryDeviceAttribEXT == nullptr) return std::nullopt;
    EGLAttrib number = -1;
    if (eglQueryDeviceAttribEXT(device, EGL_CUDA_DEVICE_NV, &number) == EGL_FALSE) eglGetError();
    return number < 0 ? std::nullopt : std::optional(static_cast<unsigned>(number));
}

EglDevice describe(EGLDeviceEXT handle, unsigned index) {
    EglDevice device;
    device.handle = handle;
    device.index = index;
    // Queries the extensions first: a driver may crash on a query that the device does not list. NVIDIA 450 does so for
    // GPUs that a container hides.
    device.extensions = deviceString(handle, EGL_EXTENSIONS);
    device.deviceClass = classify(device.extensions);
    if (hasExtension(device.extensions, "EGL_EXT_device_query_name")) {
        device.name = deviceString(handle, EGL_RENDERER_EXT);
    }
    if (hasExtension(device.extensions, "EGL_EXT_device_drm")) {
        device.drmFile = deviceString(handle, EGL_DRM_DEVICE_FILE_EXT);
    }
    device.cudaNumber = cudaNumber(handle, device.extensions);
    spdlog::debug("EGL device {}: {} {} {} [{}]", index, device.name, device.drmFile,
                  device.cudaNumber ? fmt::format("CUDA device {}", *device.cudaNumber) : "", device.extensions);
    return device;
}

}  // namespace

std::vector<EglDevice> eglDevices() {
    if (eglQueryDevicesEXT == nullptr || eglQueryDeviceStringEXT == nullptr) return {};
    EGLint count = 0;
    if (eglQueryDevicesEXT(0, nullptr, &count) == EGL_FALSE || count <= 0) return {};
    std::vector<EGLDeviceEXT> handles(static_cast<std::size_t>(count));
    if (eglQueryDevicesEXT(count, handles.data(), &count) == EGL_FALSE) return {};
    handles.resize(static_cast<std::size_t>(count));

    std::vector<EglDevice> devices;
    for (unsigned index = 0; index < handles.size(); ++index) devices.push_back(describe(handles[index], index));
    std::stable_sort(devices.begin(), devices.end(),
                     [](const auto& a, const auto& b) { return a.deviceClass < b.deviceClass; });
    return devices;
}

}  // namespace spherule::compute::gl
