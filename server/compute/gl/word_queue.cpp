#include "compute/gl/word_queue.h"

#include <cstring>
#include <utility>

#include "compute/check.h"
#include "compute/gl/buffer.h"
#include "compute/gl/fences.h"

namespace spherule::compute::gl {

GlWordQueue::GlWordQueue(std::shared_ptr<Context> context)
    : context_(std::move(context)), staging_(context_, Staging::Direction::FromDevice) {
    static_cast<void>(staging_.reserve(most * sizeof(std::uint32_t)));  // without memory, take() tells of a lost device
}

GlWordQueue::~GlWordQueue() {
    context_->use();
    for (GLsync fence : fences_) glDeleteSync(fence);
}

void GlWordQueue::start(const Buffer& buffer, std::size_t offset) {
    checkRange("copy of a word", buffer, offset, sizeof(std::uint32_t));
    if (fences_.size() == most) programError("too many words are under way");
    context_->use();
    if (staging_.data() != nullptr) {
        context_->state().beforeCopy();
        glCopyNamedBufferSubData(static_cast<const GlBuffer&>(buffer).id(), staging_.id(),
                                 static_cast<GLintptr>(offset), static_cast<GLintptr>(next_ * sizeof(std::uint32_t)),
                                 sizeof(std::uint32_t));
        context_->state().afterCopy();
    }
    next_ = (next_ + 1) % most;
    fences_.push_back(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
}

std::uint32_t GlWordQueue::take() {
    if (fences_.empty()) programError("no word is under way");
    context_->use();
    const std::size_t place = (next_ + most - fences_.size()) % most;
    waitFor(*context_, fences_.front());
    glDeleteSync(fences_.front());
    fences_.pop_front();
    std::uint32_t word = ~0U;
    if (staging_.data() != nullptr && context_->resetCause() == nullptr)
        std::memcpy(&word, staging_.data() + place * sizeof word, sizeof word);
    return word;
}

}  // namespace spherule::compute::gl
