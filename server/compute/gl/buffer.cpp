#include "compute/gl/buffer.h"

#include <algorithm>
#include <string>

#include <spdlog/fmt/fmt.h>

namespace spherule::compute::gl {
namespace {

// Returns the first error since the last call, and clears all others.
GLenum takeError() {
    const GLenum first = glGetError();
    // A lost context reports its error forever.
    for (GLenum next = first; next != GL_NO_ERROR && next != GL_CONTEXT_LOST;) next = glGetError();
    return first;
}

}  // namespace

Result<std::unique_ptr<Buffer>> GlBuffer::create(const std::shared_ptr<Context>& context, std::string_view label,
                                                 std::size_t bytes) {
    context->use();
    takeError();
    std::unique_ptr<GlBuffer> buffer(new GlBuffer(context, bytes));
    glObjectLabel(GL_BUFFER, buffer->id_, static_cast<GLsizei>(label.size()), label.data());
    constexpr std::size_t unit = 16;
    const std::size_t rounded = std::max(unit, (bytes + unit - 1) / unit * unit);
    glNamedBufferStorage(buffer->id_, static_cast<GLsizeiptr>(rounded), nullptr, GL_DYNAMIC_STORAGE_BIT);
    const GLuint zero = 0;
    glClearNamedBufferData(buffer->id_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
    if (const GLenum error = takeError(); error != GL_NO_ERROR) {
        if (const char* const cause = context->resetCause())
            return fail(ErrorKind::DeviceLost, context->renderer(), fmt::format("the device was reset: {}", cause));
        return fail(ErrorKind::Refused, std::string(label),
                    fmt::format("the device has no room for {:.1f} MiB ({}); use fewer spheres or a device with more "
                                "memory",
                                static_cast<double>(bytes) / (1 << 20),
                                error == GL_OUT_OF_MEMORY ? "out of memory" : fmt::format("GL error 0x{:x}", error)),
                    Cause::NoMemory);
    }
    return buffer;
}

GlBuffer::GlBuffer(std::shared_ptr<Context> context, std::size_t bytes) : context_(std::move(context)), bytes_(bytes) {
    glCreateBuffers(1, &id_);
}

GlBuffer::~GlBuffer() {
    context_->use();
    context_->state().forgetBuffer(id_);
    glDeleteBuffers(1, &id_);
}

}  // namespace spherule::compute::gl
