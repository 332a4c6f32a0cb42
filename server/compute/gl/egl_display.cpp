#include "compute/gl/egl_display.h"

#include <cstdlib>
#include <map>
#include <mutex>

#include <spdlog/fmt/fmt.h>

#include "compute/gl/egl_api.h"

namespace spherule::compute::gl {
namespace {

std::mutex registryMutex;

// The open displays, so that none is terminated while another user has it.
std::map<EGLDisplay, std::weak_ptr<EglDisplay>>& registry() {
    static std::map<EGLDisplay, std::weak_ptr<EglDisplay>> open;
    return open;
}

// glad loads the EGL 1.5 function only once a display exists, so the extension's function is tried first.
EGLDisplay platformDisplay(EGLenum platform, void* native) {
    if (eglGetPlatformDisplayEXT != nullptr) return eglGetPlatformDisplayEXT(platform, native, nullptr);
    if (eglGetPlatformDisplay != nullptr) return eglGetPlatformDisplay(platform, native, nullptr);
    return EGL_NO_DISPLAY;
}

std::string advice(EGLint code) {
    if (code == EGL_BAD_ACCESS)
        return " (a MIG slice of a GPU offers no OpenGL; a file under /dev may be closed to you)";
    if (code == EGL_BAD_ALLOC) return " (the driver finds no GPU that it may use)";
    return "";
}

Result<std::shared_ptr<EglDisplay>> open(EGLenum platform, void* native, const std::string& name) {
    const std::lock_guard lock(registryMutex);
    EGLDisplay handle = platformDisplay(platform, native);
    if (handle == EGL_NO_DISPLAY) {
        return fail(ErrorKind::NoDevice, name, fmt::format("EGL gives no display: {}", eglErrorName(eglGetError())));
    }
    if (auto shared = registry()[handle].lock()) return shared;
    if (eglInitialize(handle, nullptr, nullptr) == EGL_FALSE) {
        const EGLint code = eglGetError();
        return fail(ErrorKind::NoDevice, name,
                    fmt::format("cannot be initialised: {}{}", eglErrorName(code), advice(code)));
    }
    loadDisplayFunctions(handle);
    auto display = std::make_shared<EglDisplay>(handle, name);
    registry()[handle] = display;
    return display;
}

std::string displayString(EGLDisplay display, EGLint name) {
    const char* const text = eglQueryString(display, name);
    return text == nullptr ? std::string() : text;
}

}  // namespace

Result<std::shared_ptr<EglDisplay>> EglDisplay::forDevice(const EglDevice& device) {
    return open(EGL_PLATFORM_DEVICE_EXT, device.handle, fmt::format("EGL device {}", device.index));
}

Result<std::shared_ptr<EglDisplay>> EglDisplay::surfaceless(bool software) {
    const std::string name = "EGL without a surface";
    if (!hasExtension(clientExtensions(), "EGL_MESA_platform_surfaceless")) {
        return fail(ErrorKind::NoDevice, name, "this EGL does not offer it; Mesa's does (apt install libegl-mesa0)");
    }
    if (software) setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    return open(EGL_PLATFORM_SURFACELESS_MESA, nullptr, name);
}

EglDisplay::EglDisplay(EGLDisplay handle, std::string name) : handle_(handle), name_(std::move(name)) {}

EglDisplay::~EglDisplay() {
    const std::lock_guard lock(registryMutex);
    // Another thread may have opened the display again after the last user released it.
    const auto entry = registry().find(handle_);
    if (entry != registry().end() && !entry->second.expired()) return;
    registry().erase(handle_);
    eglTerminate(handle_);
}

std::string EglDisplay::extensions() const {
    return displayString(handle_, EGL_EXTENSIONS);
}
std::string EglDisplay::vendor() const {
    return displayString(handle_, EGL_VENDOR);
}

}  // namespace spherule::compute::gl
