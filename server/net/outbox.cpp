#include "net/outbox.h"

#include <algorithm>
#include <utility>

namespace spherule::net {

namespace {

// Of these an older one has nothing to say any more.
bool replaceable(v1::ServerMessage::KindCase kind) {
    using enum v1::ServerMessage::KindCase;
    return kind == kScene || kind == kOrder || kind == kSettings || kind == kDial || kind == kDiagnostics ||
           kind == kStream || kind == kTimeline || kind == kRecording || kind == kControl || kind == kChange;
}

}  // namespace

void Outbox::follow(const codec::Rendition& rendition) {
    rendition_ = rendition;
    lose();
}

bool Outbox::lose(std::uint64_t sequence) {
    if (rendition_.rate == 0 || sequence < keyframe_) return false;
    lose();
    return true;
}

void Outbox::lose() {
    number_.reset();
    frame_.reset();
}

bool Outbox::push(codec::SharedMessage message) {
    const auto kind = message->content().kind_case();
    if (replaceable(kind))
        std::erase_if(reliable_, [kind](const auto& waiting) { return waiting->content().kind_case() == kind; });
    if (reliable_.size() >= capacity_) return false;
    if (message->content().has_scene()) {
        epoch_ = message->content().scene().epoch();
        order_.reset();
    }
    if (message->content().has_order()) order_ = message->content().order().number();
    reliable_.push_back(std::move(message));
    return true;
}

Outbox::Offered Outbox::offer(const codec::EncodedFrame& encoded) {
    if (rendition_.rate == 0 || encoded.rendition != rendition_) return Offered::Fine;
    const bool keyframe = encoded.kind != codec::EncodedFrame::Kind::Delta;
    if (numbered_ != encoded.message->content().frame().epoch()) lose();
    if (keyframe && number_ == encoded.number) return Offered::Fine;  // for those who lack it
    if (!keyframe && !number_) return Offered::Fine;                  // lost before
    if (!keyframe && (frame_ || encoded.number != *number_ + 1)) {
        const Offered why = frame_ ? Offered::Busy : Offered::Gap;
        lose();
        return why;
    }
    if (keyframe) keyframe_ = encoded.message->content().frame().sequence();
    number_ = encoded.number;
    numbered_ = encoded.message->content().frame().epoch();
    frame_ = encoded.message;
    return Offered::Fine;
}

codec::SharedMessage Outbox::next(bool frames) {
    if (!reliable_.empty()) {
        auto message = std::move(reliable_.front());
        reliable_.pop_front();
        return message;
    }
    if (!frames || !frameIsDescribed()) return nullptr;
    return std::exchange(frame_, nullptr);
}

bool Outbox::frameIsDescribed() const {
    return frame_ && epoch_ == frame_->content().frame().epoch() && order_ == frame_->content().frame().order();
}

void Outbox::clear() {
    reliable_.clear();
    frame_.reset();
}

}  // namespace spherule::net
