#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "encode/places.h"
#include "encode/stream_encoder.h"
#include "host/simulation_host.h"
#include "net/publisher.h"
#include "recording/live_recorder.h"

namespace spherule::host {

// The frames of a simulation, and the messages about its spheres that they need. Sessions that follow the population
// get Population messages when spheres are added or removed. The others, and the recorder, get a new epoch. Used by the
// simulation thread.
class StateStreams {
  public:
    using Clock = encode::StreamEncoder::Clock;

    // `published`: called for each frame. `warn`: sends to viewers and to the log. All must outlive the streams.
    StateStreams(SimulationHost& host, net::Publisher& publisher, recording::LiveRecorder& recorder,
                 std::function<void()> published, encode::StreamEncoder::Warn warn);

    // The present state.
    struct Moment {
        std::uint64_t version = 0;        // changes when the spheres may have moved
        std::function<v1::Frame()> head;  // of a frame of it
    };

    // Sends the facts of another world, or of its replaced spheres.
    void beginWorld();
    // Publishes frames that are ready, and begins those that are due. Tells the sessions which spheres were added or
    // removed.
    void produce(const Moment& moment, std::vector<codec::Subscription> subscriptions, Clock::time_point now);
    // Reserves the device memory for frames of the recorder.
    Result<void> open(const codec::Rendition& rendition, const Moment& moment);
    // When to call produce() again, as StreamEncoder::due().
    [[nodiscard]] std::optional<Clock::time_point> due() const;
    [[nodiscard]] std::uint64_t framesMade() const { return framesMade_; }

  private:
    // Identifies a state of the world: its version, and the simulated time (s), which changes within a step too.
    struct State {
        std::uint64_t version = 0;
        double time = 0;
        bool operator==(const State&) const = default;
    };

    void publish(const codec::EncodedFrame& encoded);
    encode::FrameSource sourceAt(const Moment& moment);
    encode::EncoderInput inputOfOthers(const Moment& moment);
    encode::EncoderInput inputOfFollowers(const Moment& moment);
    bool renewGroups(Clock::time_point now);
    void renewOthers();
    void beginFollowers();
    void followPopulation(bool watched, Clock::time_point now);

    SimulationHost& host_;
    net::Publisher& publisher_;
    recording::LiveRecorder& recorder_;
    std::function<void()> published_;
    std::uint64_t framesMade_ = 0;
    encode::StreamEncoder others_;
    encode::StreamEncoder followers_;
    std::optional<State> figuresOf_;  // the state whose figures are in figures_
    compute::Buffer* figures_ = nullptr;
    std::uint32_t lastEpoch_ = 0;  // of all that clients have seen
    std::uint32_t othersEpoch_ = 0;
    std::uint64_t othersVersion_ = 0;  // of the population, in this epoch
    Clock::time_point nextRenewal_{};
    std::uint64_t groupsVersion_ = 0;  // of the groups and materials that clients know
    Clock::time_point nextGroups_{};
    // The followers' epoch.
    std::uint32_t epoch_ = 0;
    encode::Places places_{sim::Population()};
    std::uint32_t number_ = 0;   // of the last Population message
    std::uint32_t inFacts_ = 0;  // the number that the retained facts include
    std::size_t groups_ = 0;     // that the followers know
    std::uint64_t version_ = 0;  // of the population
    Clock::time_point nextBegin_{};
};

}  // namespace spherule::host
