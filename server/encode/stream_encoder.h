#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "codec/rendition.h"
#include "compute/device.h"
#include "encode/frame_encoder.h"

namespace spherule::encode {

// The spheres in the order of the codec.
struct CodecOrder {
    std::vector<std::uint32_t> ids;      // their numbers in frames: a permutation of 0, 1, ...
    std::vector<std::uint32_t> handles;  // the handle of each on the device
};

// The data that the streams need.
struct EncoderInput {
    FrameSource source;
    std::uint32_t spheres = 0;          // in frames
    double smallestRadius = 0;          // m
    glm::dvec3 periods{};               // m: length of each periodic axis; 0: not periodic
    std::uint32_t epoch = 0;            // changes when the spheres are replaced
    std::uint64_t version = 0;          // changes when the spheres may have moved
    std::uint32_t population = 0;       // number of the last Population message
    std::function<CodecOrder()> order;  // for a new epoch; may wait for the device
    std::function<v1::Frame()> head;    // head of a frame of the present state: step, time, status
};

// Encodes the frames of each rendition that somebody requests, as a chain: a keyframe, then deltas. Each chain has its
// own FrameEncoder on the device. Nothing is encoded, copied or kept for other renditions. Used by the simulation
// thread.
//
// The way of a frame, from the device to the socket of a session:
//
//   FrameProducer ── update() ──> StreamEncoder ── keyframe, delta or resync ──> FrameEncoder (kernels on the device)
//                                       |                                             |
//                                       |<─────────────── poll(): bytes ──────────────+
//                                       v
//   net::Publisher::publish() ──> Hub ──> Session::offer() ──> SendQueue: one frame waits, the newest replaces it
//                                                                  |
//                              AckWindow, RateController: when     v
//                              the next frame may be sent ──> WebSocket write ──> client ── Ack ──> AckWindow
class StreamEncoder {
  public:
    using Clock = std::chrono::steady_clock;
    using Publish = std::function<void(const codec::EncodedFrame&)>;
    using PublishOrder = std::function<void(codec::SharedMessage)>;
    using Warn = std::function<void(const std::string&)>;  // sends to viewers and to the log

    // `sequence`: counts the frames of all encoders that share it.
    StreamEncoder(compute::Device& device, Publish publish, PublishOrder publishOrder, Warn warn,
                  std::uint64_t& sequence);

    // Publishes the frames that have arrived, and starts the frames that are due. A chain without room on the device is
    // left out and reported. It is tried again after 10 s, or in another epoch.
    void update(const EncoderInput& input, const std::vector<codec::Subscription>& subscriptions,
                Clock::time_point now);

    // Creates the chain if it does not exist. Fails if there is no room for it. The next update() must subscribe to it,
    // or removes it.
    Result<void> open(const codec::Rendition& rendition, const EncoderInput& input);

    // True if the epoch has an order, which suits the source: frames of it were made, or may be.
    [[nodiscard]] bool hasOrder(std::uint32_t epoch, const FrameSource& source) const {
        return context_ && epoch == epoch_ && slots_ == (source.slotOf != nullptr);
    }
    // Sets the handles in the codec's order, for the next frames of the epoch.
    void setHandles(std::span<const std::uint32_t> handles) { context_->setOrder(handles); }

    // When to call update() again; nullopt if there is nothing to do before the world or the subscriptions change.
    [[nodiscard]] std::optional<Clock::time_point> due() const;

  private:
    // One chain, and its frame that is being encoded.
    struct Chain {
        std::unique_ptr<FrameEncoder> encoder;
        std::optional<v1::Frame> inProgress;
        codec::EncodedFrame::Kind kind = codec::EncodedFrame::Kind::Keyframe;
        std::uint64_t version = 0;     // version of the world in the newest frame
        v1::Frame newest;              // head of the newest frame
        std::uint64_t startedAt = 0;   // order in which frames were started: the oldest is copied first
        Clock::time_point next{};      // when the next frame is due
        Clock::time_point keyframe{};  // time of the last keyframe
        Clock::time_point hash{};      // time of the last frame with a hash
    };

    Result<void> prepare(const EncoderInput& input);
    Result<Chain*> chainOf(const codec::Rendition& rendition, const EncoderInput& input);
    Chain* chainFor(const codec::Subscription& subscription, const EncoderInput& input, Clock::time_point now);
    void begin(const codec::Subscription& subscription, Chain& chain, const EncoderInput& input, Clock::time_point now);
    void start(Chain& chain, codec::EncodedFrame::Kind kind, v1::Frame head, const FrameSource& source,
               Clock::time_point now);
    void collect(const codec::Rendition& rendition, Chain& chain);

    compute::Device& device_;
    Publish publish_;
    PublishOrder publishOrder_;
    Warn warn_;
    std::unique_ptr<EncoderContext> context_;
    bool slots_ = false;
    std::uint32_t epoch_ = 0;
    std::uint32_t order_ = 0;
    std::uint64_t version_ = 0;  // version of the world in the last update()
    std::map<codec::Rendition, Chain> chains_;
    std::uint64_t starts_ = 0;
    Clock::time_point retry_{};       // when to try refused chains again
    std::uint32_t refusedEpoch_ = 0;  // epoch of the last refused chain
    std::uint64_t& sequence_;
};

}  // namespace spherule::encode
