#include "compute/gl/fences.h"

#include <utility>

#include "core/heartbeat.h"

namespace spherule::compute::gl {
namespace {

// Few enough that they end within seconds on a slow device, enough that the cost of fences is negligible.
constexpr unsigned launchesPerFence = 64;
// Limits how far the host is ahead of the device, so that the next request does not wait for minutes of work.
constexpr std::size_t mostFences = 4;
constexpr GLuint64 look = 1'000'000'000;  // ns; then checks for a lost context, which some drivers do not signal

}  // namespace

void waitFor(Context& context, GLsync fence) {
    heartbeat::beat("waiting for the device");
    while (glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, look) == GL_TIMEOUT_EXPIRED && !context.resetCause()) {
    }
}

Fences::Fences(std::shared_ptr<Context> context) : context_(std::move(context)) {}

Fences::~Fences() {
    context_->use();
    for (GLsync fence : fences_) glDeleteSync(fence);
}

void Fences::launched() {
    if (++launches_ < launchesPerFence) return;
    add();
    if (fences_.size() > mostFences) waitForFirst();
}

void Fences::wait() {
    add();
    while (!fences_.empty()) waitForFirst();
}

void Fences::waitForFirst() {
    waitFor(*context_, fences_.front());
    glDeleteSync(fences_.front());
    fences_.pop_front();
}

void Fences::add() {
    launches_ = 0;
    fences_.push_back(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
}

}  // namespace spherule::compute::gl
