#pragma once

#include <memory>
#include <string>

#include <glad/gl.h>

#include "compute/gl/egl_display.h"
#include "compute/gl/state.h"
#include "core/result.h"

namespace spherule::compute::gl {

// One OpenGL 4.5 core context without a surface. Everything that lives in it keeps it alive. Used by one thread, which
// may use several contexts in turn.
class Context {
  public:
    // Asks for robust access with a reset that loses the context; takes one without where the driver refuses. In debug
    // builds the driver's messages go to the log.
    static Result<std::shared_ptr<Context>> create(const std::shared_ptr<EglDisplay>& display);

    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    // Makes it the thread's current context; costs a comparison when it is.
    void use() {
        if (current_ != this) makeCurrent();
    }

    // What the context is set to.
    State& state() { return state_; }

    [[nodiscard]] bool robust() const { return robust_; }
    [[nodiscard]] const std::string& renderer() const { return renderer_; }
    [[nodiscard]] const std::string& vendor() const { return vendor_; }
    [[nodiscard]] const std::string& version() const { return version_; }
    [[nodiscard]] const EglDisplay& display() const { return *display_; }

    // Why the device was reset, which this context does not survive; null while it has not been. Asks the driver.
    const char* resetCause();

    // True for the names of renderers that run on the CPU.
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
