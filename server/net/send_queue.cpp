#include "net/send_queue.h"

#include <algorithm>
#include <utility>

namespace spherule::net {

namespace {

// Kinds of which only the newest message matters: a new one replaces a queued one.
bool replaceable(v1::ServerMessage::KindCase kind) {
    using enum v1::ServerMessage::KindCase;
    return kind == kScene || kind == kOrder || kind == kSettings || kind == kDial || kind == kDiagnostics ||
           kind == kStream || kind == kTimeline || kind == kRecording || kind == kControl || kind == kChange ||
           kind == kParts;
}

}  // namespace

void SendQueue::follow(const codec::Rendition& rendition) {
    rendition_ = rendition;
    breakChain();
}

bool SendQueue::reportLoss(std::uint64_t sequence) {
    if (rendition_.rate == 0 || sequence < keyframeSequence_) return false;
    breakChain();
    return true;
}

void SendQueue::breakChain() {
    lastNumber_.reset();
    frame_.reset();
}

void SendQueue::dropChanges() {
    std::erase_if(reliable_, [](const auto& waiting) { return waiting->content().has_population(); });
}

bool SendQueue::push(codec::SharedMessage message) {
    constexpr auto mostChanges = 24;  // leaves room for other messages
    const auto kind = message->content().kind_case();
    if (message->content().has_scene()) dropChanges();
    if (message->content().has_population()) {
        if (awaitsScene_) return true;
        if (std::ranges::count_if(reliable_, [](const auto& one) { return one->content().has_population(); }) >=
            mostChanges) {
            dropChanges();
            missedChanges_ = awaitsScene_ = true;
            return true;
        }
        population_ = message->content().population().number();
    }
    if (replaceable(kind))
        std::erase_if(reliable_, [kind](const auto& waiting) { return waiting->content().kind_case() == kind; });
    if (reliable_.size() >= capacity_) return false;
    if (message->content().has_scene()) {
        // The same epoch again: the client has missed changes of the population.
        if (sceneEpoch_ != message->content().scene().epoch()) orderNumber_.reset();
        sceneEpoch_ = message->content().scene().epoch();
        population_ = message->content().scene().population();
        awaitsScene_ = false;
    }
    if (message->content().has_order()) orderNumber_ = message->content().order().number();
    reliable_.push_back(std::move(message));
    return true;
}

SendQueue::OfferResult SendQueue::offer(const codec::EncodedFrame& encoded) {
    if (rendition_.rate == 0 || encoded.rendition != rendition_) return OfferResult::Accepted;
    const bool keyframe = encoded.kind != codec::EncodedFrame::Kind::Delta;
    if (lastEpoch_ != encoded.message->content().frame().epoch()) breakChain();
    if (keyframe && lastNumber_ == encoded.number) return OfferResult::Accepted;  // a resync for other viewers
    if (!keyframe && !lastNumber_) return OfferResult::Accepted;                  // chain lost already
    if (!keyframe && (frame_ || encoded.number != *lastNumber_ + 1)) {
        const OfferResult why = frame_ ? OfferResult::Busy : OfferResult::Gap;
        breakChain();
        return why;
    }
    if (keyframe) keyframeSequence_ = encoded.message->content().frame().sequence();
    lastNumber_ = encoded.number;
    lastEpoch_ = encoded.message->content().frame().epoch();
    frame_ = encoded.message;
    return OfferResult::Accepted;
}

codec::SharedMessage SendQueue::next(bool frames) {
    if (!reliable_.empty()) {
        auto message = std::move(reliable_.front());
        reliable_.pop_front();
        return message;
    }
    if (!frames || !frameIsReady()) return nullptr;
    return std::exchange(frame_, nullptr);
}

bool SendQueue::frameIsReady() const {
    return frame_ && sceneEpoch_ == frame_->content().frame().epoch() &&
           orderNumber_ == frame_->content().frame().order() && !awaitsScene_ &&
           population_ >= frame_->content().frame().population();
}

void SendQueue::clear() {
    reliable_.clear();
    frame_.reset();
}

}  // namespace spherule::net
