#include "compute/gl/context.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

#include <spdlog/fmt/fmt.h>

#include "compute/gl/debug.h"
#include "compute/gl/egl_api.h"

namespace spherule::compute::gl {
namespace {

// Returns the config for a context; nullopt if there is none. The config may have any surfaces or none: the program
// draws to no surface, and a headless driver may offer only configs without windows.
std::optional<EGLConfig> chooseConfig(const EglDisplay& display) {
    if (hasExtension(display.extensions(), "EGL_KHR_no_config_context")) return EGL_NO_CONFIG_KHR;
    constexpr std::array wanted{EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display.handle(), wanted.data(), &config, 1, &count) == EGL_FALSE || count < 1) return {};
    return config;
}

std::vector<EGLint> contextAttributes(bool robust) {
    std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION,       4,
                                   EGL_CONTEXT_MINOR_VERSION,       5,
                                   EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
    if (debugBuild) attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});
    if (robust) {
        attributes.insert(attributes.end(),
                          {EGL_CONTEXT_OPENGL_ROBUST_ACCESS, EGL_TRUE, EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                           EGL_LOSE_CONTEXT_ON_RESET});
    }
    attributes.push_back(EGL_NONE);
    return attributes;
}

// The entry points are the same for all contexts of a process. They are loaded once, while a context is current.
bool loadGl() {
    static const bool loaded = gladLoadGL(eglGetProcAddress) != 0;
    return loaded;
}

std::string glString(GLenum name) {
    const auto* const text = reinterpret_cast<const char*>(glGetString(name));
    return text == nullptr ? std::string() : text;
}

}  // namespace

thread_local Context* Context::current_ = nullptr;

Result<std::shared_ptr<Context>> Context::create(const std::shared_ptr<EglDisplay>& display) {
    const std::string where = display->name();
    if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) {
        return fail(ErrorKind::NoDevice, where, "offers no OpenGL, only OpenGL ES");
    }
    if (!hasExtension(display->extensions(), "EGL_KHR_surfaceless_context")) {
        return fail(ErrorKind::NoDevice, where, "cannot compute without a surface (EGL_KHR_surfaceless_context)");
    }
    const auto config = chooseConfig(*display);
    if (!config) return fail(ErrorKind::NoDevice, where, "has no EGL config for OpenGL");
    for (const bool robust : {true, false}) {
        const auto attributes = contextAttributes(robust);
        EGLContext handle = eglCreateContext(display->handle(), *config, EGL_NO_CONTEXT, attributes.data());
        if (handle == EGL_NO_CONTEXT) continue;
        const std::shared_ptr<Context> context(new Context(display, handle, robust));
        if (auto started = context->start(); !started) return tl::unexpected(started.error());
        return context;
    }
    return fail(ErrorKind::NoDevice, where,
                fmt::format("offers no OpenGL 4.5 core context: {}; a newer driver may", eglErrorName(eglGetError())));
}

Context::Context(std::shared_ptr<EglDisplay> display, EGLContext handle, bool robust)
    : display_(std::move(display)), handle_(handle), robust_(robust) {}

Context::~Context() {
    if (current_ == this) {
        eglMakeCurrent(display_->handle(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        current_ = nullptr;
    }
    eglDestroyContext(display_->handle(), handle_);
}

Result<void> Context::start() {
    if (!makeCurrent()) {
        return fail(ErrorKind::NoDevice, display_->name(),
                    fmt::format("its context cannot be made current: {}", eglErrorName(eglGetError())));
    }
    if (!loadGl()) return fail(ErrorKind::NoDevice, display_->name(), "OpenGL's functions cannot be loaded");
    GLint buffers = 0;
    glGetIntegerv(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS, &buffers);
    if (static_cast<std::size_t>(buffers) < maxKernelBuffers)
        return fail(ErrorKind::NoDevice, display_->name(),
                    fmt::format("allows a kernel {} storage buffers; {} are needed", buffers, maxKernelBuffers));
    renderer_ = glString(GL_RENDERER);
    vendor_ = glString(GL_VENDOR);
    version_ = glString(GL_VERSION);
    GLint strategy = GL_NO_RESET_NOTIFICATION;
    glGetIntegerv(GL_RESET_NOTIFICATION_STRATEGY, &strategy);
    robust_ = robust_ && strategy == GL_LOSE_CONTEXT_ON_RESET;
    if (debugBuild) logDriverMessages();
    return {};
}

bool Context::makeCurrent() {
    if (eglMakeCurrent(display_->handle(), EGL_NO_SURFACE, EGL_NO_SURFACE, handle_) == EGL_FALSE) return false;
    current_ = this;
    return true;
}

const char* Context::resetCause() {
    if (resetCause_ != nullptr) return resetCause_;  // the driver may report it only once
    use();
    // Other values are ignored: without robust access some drivers return undefined values.
    switch (glGetGraphicsResetStatus()) {
        case GL_GUILTY_CONTEXT_RESET:
            resetCause_ = "a kernel of this program hung or crashed it";
            break;
        case GL_INNOCENT_CONTEXT_RESET:
            resetCause_ = "another program hung or crashed it";
            break;
        case GL_UNKNOWN_CONTEXT_RESET:
            resetCause_ = "the driver does not say why";
            break;
        default:
            break;
    }
    return resetCause_;
}

bool Context::software() const {
    constexpr std::array<std::string_view, 4> names{"llvmpipe", "softpipe", "swrast", "SwiftShader"};
    return std::any_of(names.begin(), names.end(),
                       [this](auto name) { return renderer_.find(name) != std::string::npos; });
}

}  // namespace spherule::compute::gl
