#pragma once

#include <memory>
#include <string>

#include <glad/egl.h>

#include "compute/gl/egl_devices.h"
#include "core/result.h"

namespace spherule::compute::gl {

// An initialised EGL display without a screen. EGL has one per device and process, so those who ask for the same device
// share it; it ends with the last of them. Any thread.
class EglDisplay {
  public:
    static Result<std::shared_ptr<EglDisplay>> forDevice(const EglDevice& device);

    // For hosts whose EGL lists no devices: Mesa picks one. With `software`, Mesa is told to use its software renderer
    // (by its environment variable, for the rest of the process: call it before other threads start).
    static Result<std::shared_ptr<EglDisplay>> surfaceless(bool software);

    EglDisplay(EGLDisplay handle, std::string name);
    ~EglDisplay();
    EglDisplay(const EglDisplay&) = delete;
    EglDisplay& operator=(const EglDisplay&) = delete;

    [[nodiscard]] EGLDisplay handle() const { return handle_; }
    [[nodiscard]] const std::string& name() const { return name_; }  // "EGL device 0", for messages
    [[nodiscard]] std::string extensions() const;
    [[nodiscard]] std::string vendor() const;

  private:
    EGLDisplay handle_;
    std::string name_;
};

}  // namespace spherule::compute::gl
