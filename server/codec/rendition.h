#pragma once

#include <array>
#include <compare>
#include <cstdint>

#include "codec/message.h"
#include "spherule/v1/frame.pb.h"

// Chains of frames, as the simulation makes them and the network hands them on.
namespace spherule::codec {

// One chain: all who watch it are sent the same frames.
struct Rendition {
    v1::Tier tier = v1::NORMAL;
    std::uint32_t rate = 0;  // frames per second, one of `rates`

    auto operator<=>(const Rendition&) const = default;
};

// Few, so that viewers share chains.
constexpr std::array<std::uint32_t, 5> rates = {5, 10, 20, 30, 60};

// The highest that is not above what was asked; at least the lowest; 0 for 0.
std::uint32_t rateFor(std::uint32_t asked);

// Metres per unit of the codec, for scenes whose smallest radius this is: positions are off by half of it at most.
double quantumOf(v1::Tier tier, double smallestRadius);

// A frame of a chain, with its number there.
struct EncodedFrame {
    enum class Kind : std::uint8_t {
        Delta,     // for who has the one before
        Keyframe,  // the chain begins anew: for all
        Resync     // a keyframe of a state that others have already: for who waits for one
    };
    Rendition rendition;
    Kind kind = Kind::Delta;
    std::uint32_t number = 0;
    SharedMessage message;
};

// What somebody watches.
struct Subscription {
    Rendition rendition;
    bool newcomer = false;  // somebody has had no frame yet
    bool lost = false;      // somebody has lost the chain
};

}  // namespace spherule::codec
