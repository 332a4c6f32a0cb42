#include "net/outbox.h"

#include <algorithm>
#include <utility>

namespace spherule::net {

Outbox::Outbox(std::size_t capacity, std::uint32_t rate) : capacity_(capacity), rate_(rate) {}

void Outbox::setRate(std::uint32_t rate) {
    rate_ = rate;
    if (rate_ == 0) dropFrame();
}

namespace {

// Of these an older one has nothing to say any more.
bool replaceable(v1::ServerMessage::KindCase kind) {
    return kind == v1::ServerMessage::kScene || kind == v1::ServerMessage::kSettings ||
           kind == v1::ServerMessage::kDial || kind == v1::ServerMessage::kDiagnostics;
}

}  // namespace

bool Outbox::push(frame::SharedMessage message) {
    const auto kind = message->content().kind_case();
    if (replaceable(kind))
        std::erase_if(reliable_, [kind](const auto& waiting) { return waiting->content().kind_case() == kind; });
    if (reliable_.size() >= capacity_) return false;
    if (message->content().has_scene()) epoch_ = message->content().scene().epoch();
    reliable_.push_back(std::move(message));
    return true;
}

bool Outbox::offer(frame::SharedMessage frame, Clock::time_point now) {
    if (rate_ == 0) return false;
    const bool replaced = frame_ != nullptr && now >= due_;
    frame_ = std::move(frame);
    return replaced;
}

frame::SharedMessage Outbox::next(Clock::time_point now) {
    if (!reliable_.empty()) {
        auto message = std::move(reliable_.front());
        reliable_.pop_front();
        return message;
    }
    if (!frameIsDescribed() || now < due_) return nullptr;
    // A frame that came up to half an interval late may be followed by one on time, so that jitter does not lower the
    // rate.
    const auto interval = std::chrono::duration_cast<Clock::duration>(std::chrono::seconds(1)) / rate_;
    due_ = std::max(due_, now - interval / 2) + interval;
    return std::exchange(frame_, nullptr);
}

std::optional<Outbox::Clock::time_point> Outbox::frameDue() const {
    if (!frameIsDescribed()) return std::nullopt;
    return due_;
}

bool Outbox::frameIsDescribed() const {
    return frame_ && epoch_ == frame_->content().frame().epoch();
}

void Outbox::clear() {
    reliable_.clear();
    dropFrame();
}

}  // namespace spherule::net
