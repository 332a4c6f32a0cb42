#include "compute/gl/staging.h"

#include <utility>

#include "core/log.h"

namespace spherule::compute::gl {

Staging::Staging(std::shared_ptr<Context> context, Direction direction)
    : context_(std::move(context)), direction_(direction) {}

Staging::~Staging() {
    context_->use();
    release();
}

bool Staging::reserve(std::size_t bytes) {
    if (data_ != nullptr && bytes <= bytes_) return true;
    release();
    const GLbitfield access = (direction_ == Direction::ToDevice ? GL_MAP_WRITE_BIT : GL_MAP_READ_BIT) |
                              GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    const auto size = static_cast<GLsizeiptr>(bytes);
    glCreateBuffers(1, &id_);
    glNamedBufferStorage(id_, size, nullptr, access | GL_CLIENT_STORAGE_BIT);
    data_ = static_cast<std::byte*>(glMapNamedBufferRange(id_, 0, size, access));
    bytes_ = bytes;
    if (data_ == nullptr) spdlog::error("no memory for {} bytes between the host and the device", bytes);
    return data_ != nullptr;
}

void Staging::release() {
    // Deletion also unmaps the buffer.
    glDeleteBuffers(1, &id_);
    id_ = 0;
    bytes_ = 0;
    data_ = nullptr;
}

}  // namespace spherule::compute::gl
