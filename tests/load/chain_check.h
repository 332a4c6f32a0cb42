#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "codec/decoder.h"
#include "spherule/v1/control.pb.h"

namespace spherule::load {

// What a viewer was sent, as its check saw it.
struct Received {
    std::uint64_t frames = 0;
    std::uint64_t keyframes = 0;
    std::uint64_t losses = 0;   // keyframes within a chain: one that was sent before has broken off
    std::uint64_t missed = 0;   // frames of a chain that a keyframe jumped over
    std::uint64_t ignored = 0;  // frames of an epoch that is over
    std::uint64_t hashes = 0;   // compared with those of decoded positions
    std::uint64_t chains = 0;   // begun: at the join, and at each change of tier, rate or epoch

    void operator+=(const Received& other);
};

// Holds the messages of one session against docs/protocol.md and docs/codec.md: what must come before what, that a
// delta frame follows the one before it, that who lost its chain gets a keyframe. One thread.
class ChainCheck {
  public:
    // With `decode`, frames are decoded whole and their hashes compared; without, their heads are read.
    explicit ChainCheck(bool decode) : decode_(decode) {}

    // What is wrong with the next message; nothing if it is as it must be.
    std::optional<std::string> take(const v1::ServerMessage& message);
    [[nodiscard]] const Received& received() const { return received_; }

  private:
    // What frames of the chain at hand must look like.
    struct Chain {
        std::uint32_t epoch = 0;
        v1::Tier tier = v1::TIER_UNSPECIFIED;
        double quantum = 0;
        std::uint32_t number = 0;  // of the newest frame
    };

    std::optional<std::string> scene(const v1::SceneFacts& facts);
    std::optional<std::string> order(const v1::Order& order);
    std::optional<std::string> frame(const v1::Frame& frame);
    [[nodiscard]] std::optional<std::string> described(const v1::Frame& frame) const;
    std::optional<std::string> follows(const v1::Frame& frame, const codec::FrameHead& head);

    const bool decode_;
    bool welcomed_ = false;
    std::optional<std::uint32_t> epoch_;  // of the newest facts
    std::uint32_t spheres_ = 0;
    std::optional<std::uint32_t> order_;  // of that epoch
    std::optional<v1::Stream> stream_;
    std::optional<Chain> chain_;
    std::optional<codec::Decoder> decoder_;
    std::uint64_t sequence_ = 0;
    Received received_;
};

}  // namespace spherule::load
