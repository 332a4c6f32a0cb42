#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "codec/rendition.h"

namespace spherule::net {

// What one session still has to send, in two lanes: a reliable one that is bounded, and one place for a frame. A frame
// follows the one before of its chain, or is a keyframe; it goes out only after the scene facts of its epoch and the
// order that its spheres are in. One thread.
class SendQueue {
  public:
    // `capacity` messages in the reliable lane.
    explicit SendQueue(std::size_t capacity) : capacity_(capacity) {}

    // The chain to follow, from its next keyframe on; rate 0: none.
    void follow(const codec::Rendition& rendition);

    // False when the lane is full. What says how something is now takes the place of an older one of its kind
    // that waits.
    [[nodiscard]] bool push(codec::SharedMessage message);
    enum class OfferResult : std::uint8_t {
        Accepted,
        Busy,  // the chain is lost: the frame before still waits to be sent
        Gap    // the chain is lost: the frame before has never come
    };
    OfferResult offer(const codec::EncodedFrame& encoded);
    // The client has lost the chain with the frame of this sequence. False where a newer keyframe has been taken, so
    // that it says nothing of the chain as it is now.
    bool reportLoss(std::uint64_t sequence);

    // The next message to send, the reliable lane first; frames only where `frames` says so.
    codec::SharedMessage next(bool frames);
    // It follows a chain and has nothing to send of it before a keyframe comes.
    [[nodiscard]] bool wantsKeyframe() const { return rendition_.rate > 0 && !lastNumber_; }

    void dropFrame() { frame_.reset(); }
    void clear();

  private:
    void breakChain();
    [[nodiscard]] bool frameIsReady() const;

    const std::size_t capacity_;
    codec::Rendition rendition_;
    std::optional<std::uint32_t> sceneEpoch_;   // of the latest facts
    std::optional<std::uint32_t> orderNumber_;  // the latest
    std::optional<std::uint32_t> lastNumber_;   // of the newest frame taken
    std::uint32_t lastEpoch_ = 0;               // the epoch in which: each begins to count anew
    std::uint64_t keyframeSequence_ = 0;        // sequence of the newest one taken
    std::deque<codec::SharedMessage> reliable_;
    codec::SharedMessage frame_;
};

}  // namespace spherule::net
