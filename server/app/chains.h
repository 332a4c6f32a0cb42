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

// The data of a world that the chains need.
struct Scenery {
    sim::TierSource source;
    std::uint32_t spheres = 0;
    double smallestRadius = 0;              // m
    std::uint32_t epoch = 0;                // changes when the spheres are replaced
    std::uint64_t version = 0;              // changes when the spheres may have moved
    std::function<sim::State()> positions;  // in id order; waits for the device
    std::function<v1::Frame()> head;        // head of a frame of the present state: step, time, status
};

// The chains of frames that viewers request. Each has its own encoder on the device. Nothing is encoded, copied or kept
// for other chains. Used by the simulation thread.
class Chains {
  public:
    using Clock = std::chrono::steady_clock;
    using Publish = std::function<void(const codec::EncodedFrame&)>;
    using Announce = std::function<void(codec::SharedMessage)>;
    using Complain = std::function<void(const std::string&)>;  // sends to viewers and to the log

    Chains(compute::Device& device, Publish publish, Announce announceOrder, Complain complain);

    // Publishes the frames that have arrived, and starts the frames that are due. A chain without room on the device is
    // left out and reported. It is tried again after 10 s, or in another epoch.
    void serve(const Scenery& world, const std::vector<codec::Subscription>& subscriptions, Clock::time_point now);

    // Creates the chain if it does not exist. Fails if there is no room for it. The next serve() must subscribe to it,
    // or removes it.
    Result<void> open(const codec::Rendition& rendition, const Scenery& world);

    // When to call serve() again; nullopt if there is nothing to do before the world or the subscriptions change.
    [[nodiscard]] std::optional<Clock::time_point> due() const;
    [[nodiscard]] std::uint64_t made() const { return sequence_; }  // number of frames since the start

  private:
    // One chain, and its frame that is being encoded.
    struct Chain {
        std::unique_ptr<sim::Tier> tier;
        std::optional<v1::Frame> making;
        codec::EncodedFrame::Kind kind = codec::EncodedFrame::Kind::Keyframe;
        std::uint64_t version = 0;     // version of the world in the newest frame
        v1::Frame newest;              // head of the newest frame
        std::uint64_t turn = 0;        // order in which frames were started: the oldest is copied first
        Clock::time_point next{};      // when the next frame is due
        Clock::time_point keyframe{};  // time of the last keyframe
        Clock::time_point hash{};      // time of the last frame with a hash
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
    std::uint64_t version_ = 0;  // version of the world in the last serve()
    std::map<codec::Rendition, Chain> chains_;
    std::uint64_t turns_ = 0;
    Clock::time_point retry_{};       // when to try refused chains again
    std::uint32_t refusedEpoch_ = 0;  // epoch of the last refused chain
    std::uint64_t sequence_ = 0;
};

}  // namespace spherule::app
