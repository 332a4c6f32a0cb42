#include "compute/gl/timers.h"

#include <algorithm>
#include <utility>

#include "compute/check.h"

namespace spherule::compute::gl {
namespace {

// From this number of pending spans on, begin() collects arrived spans without waiting. So their number stays small
// even if the times are never taken.
constexpr std::size_t manyPending = 4096;

double nanoseconds(GLuint query) {
    GLuint64 value = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &value);
    return static_cast<double>(value);
}

}  // namespace

Timers::Timers(std::shared_ptr<Context> context) : context_(std::move(context)) {}

Timers::~Timers() {
    context_->use();
    for (const auto* spans : {&pending_, &free_}) {
        for (const auto& span : *spans) {
            glDeleteQueries(1, &span.begin);
            glDeleteQueries(1, &span.end);
        }
    }
}

void Timers::begin(unsigned slot) {
    if (std::exchange(running_, true)) programError("a device timer is begun inside another");
    if (pending_.size() >= manyPending) collectArrived();
    pending_.push_back(takeSpan(slot));
    glQueryCounter(pending_.back().begin, GL_TIMESTAMP);
}

void Timers::end() {
    if (!std::exchange(running_, false)) programError("a device timer is ended that was not begun");
    glQueryCounter(pending_.back().end, GL_TIMESTAMP);
}

std::vector<double> Timers::take() {
    if (running_) programError("device times are taken while a timer runs");
    for (const auto& span : pending_) add(span);
    free_.insert(free_.end(), pending_.begin(), pending_.end());
    pending_.clear();
    return std::exchange(seconds_, {});
}

Timers::Span Timers::takeSpan(unsigned slot) {
    Span span;
    if (free_.empty()) {
        glCreateQueries(GL_TIMESTAMP, 1, &span.begin);
        glCreateQueries(GL_TIMESTAMP, 1, &span.end);
    } else {
        span = free_.back();
        free_.pop_back();
    }
    span.slot = slot;
    return span;
}

void Timers::collectArrived() {
    const auto waiting = std::find_if(pending_.begin(), pending_.end(), [](const Span& span) {
        GLint arrived = GL_FALSE;
        glGetQueryObjectiv(span.end, GL_QUERY_RESULT_AVAILABLE, &arrived);
        return arrived == GL_FALSE;
    });
    std::for_each(pending_.begin(), waiting, [this](const Span& span) { add(span); });
    free_.insert(free_.end(), pending_.begin(), waiting);
    pending_.erase(pending_.begin(), waiting);
}

void Timers::add(const Span& span) {
    if (seconds_.size() <= span.slot) seconds_.resize(span.slot + 1);
    seconds_[span.slot] += std::max(0.0, nanoseconds(span.end) - nanoseconds(span.begin)) * 1e-9;
}

}  // namespace spherule::compute::gl
