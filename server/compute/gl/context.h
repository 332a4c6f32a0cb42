#pragma once

#include <memory>
#include <string>

#include <glad/gl.h>

#include "compute/gl/egl_display.h"
#include "compute/gl/state.h"
#include "core/result.h"

namespace spherule::compute::gl {

// An OpenGL 4.5 core context without a surface. Its buffers, kernels and timers share ownership of it. Used by one
// thread, which may use several contexts in turn.
class Context {
  public:
    // Requests robust access, with a lost context after a reset. If the driver refuses, creates a context without it.
    // Debug builds log the driver's messages.
    static Result<std::shared_ptr<Context>> create(const std::shared_ptr<EglDisplay>& display);

    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    // Makes this the thread's current context. Costs only a comparison if it already is.
    void use() {
        if (current_ != this) makeCurrent();
    }

    // The cached settings of the context.
    State& state() { return state_; }

    [[nodiscard]] bool robust() const { return robust_; }
    [[nodiscard]] const std::string& renderer() const { return renderer_; }
    [[nodiscard]] const std::string& vendor() const { return vendor_; }
    [[nodiscard]] const std::string& version() const { return version_; }
    [[nodiscard]] const EglDisplay& display() const { return *display_; }

    // Asks the driver whether the device was reset. Returns the cause; nullptr if there was no reset. A reset loses the
    // context.
    const char* resetCause();

    // Returns true if the renderer is known to run on the CPU.
    [[nodiscard]] bool software() const;

  private:
    Context(std::shared_ptr<EglDisplay> display, EGLContext handle, bool robust);
    Result<void> start();
    bool makeCurrent();

    static thread_local Context* current_;

    std::shared_ptr<EglDisplay> display_;
    EGLContext handle_;
    bool robust_;
    std::string renderer_, vendor_, version_;
    State state_;
    const char* resetCause_ = nullptr;
};

}  // namespace spherule::compute::gl
