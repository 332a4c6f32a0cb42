#include "compute/gl/read_back.h"

#include <algorithm>
#include <utility>

namespace spherule::compute::gl {

class GlReadBack final : public ReadBack {
  public:
    using Place = ReadBackPlaces::Place;

    GlReadBack(std::shared_ptr<ReadBackPlaces> places, Place& place, std::size_t bytes)
        : places_(std::move(places)),
          place_(place),
          bytes_(bytes),
          fence_(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)) {
        place_.taken = true;
    }

    GlReadBack(const GlReadBack&) = delete;
    GlReadBack& operator=(const GlReadBack&) = delete;
    ~GlReadBack() override {
        places_->context_->use();
        glDeleteSync(fence_);
        place_.taken = false;
    }

    std::optional<std::span<const std::byte>> poll() override {
        if (!arrived_) {
            places_->context_->use();
            // Without a flush, the copy might never start.
            const GLbitfield flush = std::exchange(flushed_, true) ? 0 : GL_SYNC_FLUSH_COMMANDS_BIT;
            const GLenum state = glClientWaitSync(fence_, flush, 0);
            arrived_ = (state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED) &&
                       places_->context_->resetCause() == nullptr;  // a lost context signals without copying
        }
        if (!arrived_) return std::nullopt;
        return std::span(place_.staging.data(), bytes_);
    }

  private:
    std::shared_ptr<ReadBackPlaces> places_;
    Place& place_;
    std::size_t bytes_;
    GLsync fence_;
    bool flushed_ = false;
    bool arrived_ = false;
};

ReadBackPlaces::ReadBackPlaces(const std::shared_ptr<Context>& context)
    : context_(context),
      places_{Place{Staging(context, Staging::Direction::FromDevice)},
              Place{Staging(context, Staging::Direction::FromDevice)}} {}

std::unique_ptr<ReadBack> ReadBackPlaces::start(GLuint source, std::size_t bytes) {
    const auto free = std::find_if(places_.begin(), places_.end(), [](const Place& place) { return !place.taken; });
    if (free == places_.end() || !free->staging.reserve(bytes)) return nullptr;
    context_->state().beforeCopy();
    glCopyNamedBufferSubData(source, free->staging.id(), 0, 0, static_cast<GLsizeiptr>(bytes));
    context_->state().afterCopy();
    return std::make_unique<GlReadBack>(shared_from_this(), *free, bytes);
}

}  // namespace spherule::compute::gl
