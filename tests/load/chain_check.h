#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "codec/decoder.h"
#include "spherule/v1/control.pb.h"

namespace spherule::load {

// Counts of the messages that a viewer received.
struct Received {
    std::uint64_t frames = 0;
    std::uint64_t keyframes = 0;
    std::uint64_t losses = 0;   // keyframes within a chain, which show a lost frame
    std::uint64_t missed = 0;   // frames of a chain skipped by a keyframe
    std::uint64_t ignored = 0;  // frames of a past epoch
    std::uint64_t hashes = 0;   // hashes compared with decoded positions
    std::uint64_t chains = 0;   // chains started: at the connection, and at each change of tier, rate or epoch

    void operator+=(const Received& other);
};

// Checks the messages of one session against docs/protocol.md and docs/codec.md: the order of messages, that delta
// frames follow the previous frame, and that a keyframe follows a loss. Used by one thread.
class ChainCheck {
  public:
    // `decode`: decode whole frames and compare hashes; otherwise read only their heads.
    explicit ChainCheck(bool decode) : decode_(decode) {}

    // Returns the fault of the next message; nullopt if it has none.
    std::optional<std::string> take(const v1::ServerMessage& message);
    [[nodiscard]] const Received& received() const { return received_; }

  private:
    // Expected properties of the frames of the current chain.
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
    std::optional<std::uint32_t> order_;  // of epoch_
    std::optional<v1::Stream> stream_;
    std::optional<Chain> chain_;
    std::optional<codec::Decoder> decoder_;
    std::uint64_t sequence_ = 0;
    Received received_;
};

}  // namespace spherule::load
