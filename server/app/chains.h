#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codec/rendition.h"
#include "compute/device.h"
#include "sim/state.h"
#include "sim/tier.h"

namespace spherule::app {

// The world as the chains see it.
struct Scenery {
    sim::TierSource source;
    std::uint32_t spheres = 0;
    double smallestRadius = 0;              // m
    std::uint32_t epoch = 0;                // another one: other spheres
    std::uint64_t version = 0;              // another one: they may have moved
    std::function<sim::State()> positions;  // in id order; waits for the device
    std::function<v1::Frame()> head;        // of a frame of the present state: step, time, status
};

// The chains of frames that somebody watches, each with an encoder of its own on the device. Nothing is encoded, copied
// or kept for chains that nobody watches. Used by the simulation thread.
class Chains {
  public:
    using Clock = std::chrono::steady_clock;
    using Publish = std::function<void(const codec::EncodedFrame&)>;
    using Announce = std::function<void(codec::SharedMessage)>;
    using Complain = std::function<void(const std::string&)>;  // to viewers and the log

    Chains(compute::Device& device, Publish publish, Announce announceOrder, Complain complain);

    // Hands on the frames that have arrived, and begins those that are due. A chain that there is no room for is left
    // out, which is complained of, and tried again now and then.
    void serve(const Scenery& world, const std::vector<codec::Subscription>& subscriptions, Clock::time_point now);

    // Whether there is room for a chain: makes it where it is not there yet. The next serve() must subscribe to it, or
    // ends it.
    Result<void> open(const codec::Rendition& rendition, const Scenery& world);

    // When to call again; nothing when there is nothing to do before the world or the subscriptions change.
    [[nodiscard]] std::optional<Clock::time_point> due() const;
    [[nodiscard]] std::uint64_t made() const { return sequence_; }  // frames, ever

  private:
    // One chain, and the frame of it that is being made.
    struct Chain {
        std::unique_ptr<sim::Tier> tier;
        std::optional<v1::Frame> making;
        codec::EncodedFrame::Kind kind = codec::EncodedFrame::Kind::Keyframe;
        std::uint64_t version = 0;     // of the world in its newest frame
        v1::Frame newest;              // head of its newest frame
        std::uint64_t turn = 0;        // in which the frame was begun: the oldest is copied first
        Clock::time_point next{};      // frame
        Clock::time_point keyframe{};  // the last one
        Clock::time_point hash{};      // the last one
    };

    Result<void> prepare(const Scenery& world);
    Result<Chain*> chainOf(const codec::Rendition& rendition, const Scenery& world);
    Chain* served(const codec::Subscription& subscription, const Scenery& world, Clock::time_point now);
    void begin(const codec::Subscription& subscription, Chain& chain, const Scenery& world, Clock::time_point now);
    void start(Chain& chain, codec::EncodedFrame::Kind kind, v1::Frame head, const sim::TierSource& source,
               Clock::time_point now);
    void collect(const codec::Rendition& rendition, Chain& chain);

    compute::Device& device_;
    Publish publish_;
    Announce announceOrder_;
    Complain complain_;
    std::unique_ptr<sim::TierTools> tools_;
    bool slots_ = false;
    std::uint32_t epoch_ = 0;
    std::uint32_t order_ = 0;
    std::uint64_t version_ = 0;  // of the world when it was last served
    std::map<codec::Rendition, Chain> chains_;
    std::uint64_t turns_ = 0;
    Clock::time_point retry_{};       // of what was refused,
    std::uint32_t refusedEpoch_ = 0;  // in this epoch
    std::uint64_t sequence_ = 0;
};

}  // namespace spherule::app
