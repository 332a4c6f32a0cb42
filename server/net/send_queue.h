#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "codec/rendition.h"

namespace spherule::net {

// Messages that one session still has to send, in two lanes: a bounded reliable queue, and a slot for one frame. A
// frame is a keyframe or follows the previous frame of its chain. It is sent only after the scene facts of its epoch
// and the order of its spheres. Used by one thread.
class SendQueue {
  public:
    // `capacity`: most messages in the reliable lane.
    explicit SendQueue(std::size_t capacity) : capacity_(capacity) {}

    // Switches to the chain of `rendition`, from its next keyframe on. Rate 0: no frames.
    void follow(const codec::Rendition& rendition);

    // Appends to the reliable lane; returns false when it is full. A message that describes a current state replaces a
    // queued one of its kind.
    [[nodiscard]] bool push(codec::SharedMessage message);
    // Returns true once after Population messages were dropped, because too many waited: the session needs the scene
    // facts again.
    [[nodiscard]] bool takeMissedChanges() { return std::exchange(missedChanges_, false); }
    enum class OfferResult : std::uint8_t {
        Accepted,
        Busy,  // chain lost: the previous frame has not been sent yet
        Gap    // chain lost: the previous frame was never offered
    };
    // Puts a frame into the slot. Frames of another rendition are ignored.
    OfferResult offer(const codec::EncodedFrame& encoded);
    // The client could not decode the frame with this sequence number. Returns false, and changes nothing, when a newer
    // keyframe has been offered since.
    bool reportLoss(std::uint64_t sequence);

    // Removes and returns the next message, the reliable lane first; nullptr if there is none. `frames`: whether a
    // frame may be sent now.
    codec::SharedMessage next(bool frames);
    // Returns true when frames are wanted and none can be accepted before a keyframe.
    [[nodiscard]] bool wantsKeyframe() const { return rendition_.rate > 0 && !lastNumber_; }

    void dropFrame() { frame_.reset(); }
    void clear();

  private:
    void breakChain();
    void dropChanges();
    [[nodiscard]] bool frameIsReady() const;

    const std::size_t capacity_;
    codec::Rendition rendition_;
    std::optional<std::uint32_t> sceneEpoch_;   // of the latest scene facts queued
    std::optional<std::uint32_t> orderNumber_;  // of the latest order queued
    std::uint32_t population_ = 0;              // number of the latest change that was queued
    bool missedChanges_ = false;
    bool awaitsScene_ = false;                 // after that, until the facts come
    std::optional<std::uint32_t> lastNumber_;  // of the newest frame accepted; nullopt: chain lost
    std::uint32_t lastEpoch_ = 0;              // epoch of lastNumber_; numbers restart in each epoch
    std::uint64_t keyframeSequence_ = 0;       // of the newest keyframe accepted
    std::deque<codec::SharedMessage> reliable_;
    codec::SharedMessage frame_;
};

}  // namespace spherule::net
