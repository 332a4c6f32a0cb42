#pragma once

#include <memory>
#include <string>

#include <glad/egl.h>

#include "compute/gl/egl_devices.h"
#include "core/result.h"

namespace spherule::compute::gl {

// An initialised EGL display without a screen. EGL has one display per device and process. Users of the same device
// share the object, and the last one terminates the display. Any thread.
class EglDisplay {
  public:
    static Result<std::shared_ptr<EglDisplay>> forDevice(const EglDevice& device);

    // Opens a display on a device that Mesa chooses, for hosts whose EGL lists no devices. With `software`, sets Mesa's
    // environment variable for its software renderer, for the rest of the process. Call it before other threads start.
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
