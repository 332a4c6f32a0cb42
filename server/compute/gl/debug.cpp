#include "compute/gl/debug.h"

#include <glad/gl.h>

#include "core/log.h"

namespace spherule::compute::gl {
namespace {

spdlog::level::level_enum levelOf(GLenum type, GLenum severity) {
    if (type == GL_DEBUG_TYPE_ERROR) return spdlog::level::err;
    if (severity == GL_DEBUG_SEVERITY_HIGH) return spdlog::level::warn;
    return spdlog::level::debug;
}

void GLAD_API_PTR onMessage(GLenum, GLenum type, GLuint id, GLenum severity, GLsizei length, const GLchar* text,
                            const void*) {
    const spdlog::string_view_t message(text, static_cast<std::size_t>(length));
    spdlog::log(levelOf(type, severity), "OpenGL message {}: {}", id, message);
}

}  // namespace

void logDriverMessages() {
    glEnable(GL_DEBUG_OUTPUT);
    // Messages arrive on the calling thread, inside the faulty call, so that a debugger shows the call.
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    // Compiler messages are part of the kernel's error instead.
    glDebugMessageControl(GL_DEBUG_SOURCE_SHADER_COMPILER, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
    glDebugMessageCallback(&onMessage, nullptr);
}

}  // namespace spherule::compute::gl
