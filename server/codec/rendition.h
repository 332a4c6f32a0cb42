#pragma once

#include <array>
#include <compare>
#include <cstdint>

#include "codec/message.h"
#include "spherule/v1/frame.pb.h"

// Renditions of the frame stream. Any thread.
namespace spherule::codec {

// A precision, a frame rate and the content of frames. All sessions with the same rendition get the same chain: a
// keyframe and the delta frames after it.
struct Rendition {
    v1::Tier tier = v1::NORMAL;
    std::uint32_t rate = 0;   // frames/s, one of `rates`; 0: no frames
    bool turns = false;       // frames count modulo the lengths of periodic axes, if the scene has any (docs/codec.md)
    bool population = false;  // the sessions follow Population messages
    v1::Quantity quantity = v1::QUANTITY_UNSPECIFIED;  // that frames have besides positions
    bool spins = false;                                // frames have angular velocities, if the spheres rotate

    auto operator<=>(const Rendition&) const = default;
};

// Sessions that follow Population messages, and the others.
enum class Audience : std::uint8_t { Everybody, Followers, Others };

// Frames per second. The list is short, so that viewers share chains.
constexpr std::array<std::uint32_t, 5> rates = {5, 10, 20, 30, 60};

// Returns the highest of `rates` that is not above `asked`, at least the lowest; 0 for 0.
std::uint32_t rateFor(std::uint32_t asked);

// Returns the grid spacing of encoded positions (m) for a smallest radius (m). The largest error is half of it.
double quantumOf(v1::Tier tier, double smallestRadius);

// Returns the unit of the codes of a quantity for a smallest radius (m), see docs/codec.md.
double unitOf(v1::Quantity quantity, double smallestRadius);

// Returns the value of a code: in the middle of the values that have it; 0 for code 0.
double valueOf(std::uint32_t code, double unit);

// The unit of the codes of angular velocities (rad/s).
constexpr double spinUnit = 1;

// Returns a component of the angular velocity of a code (docs/codec.md).
double spinOf(std::int32_t code, double unit);

// A frame of a chain.
struct EncodedFrame {
    enum class Kind : std::uint8_t {
        Delta,     // needs the previous frame
        Keyframe,  // starts a chain; sent to all viewers
        Resync     // keyframe of the state after the previous frame; sent to viewers that wait for one
    };
    Rendition rendition;
    Kind kind = Kind::Delta;
    std::uint32_t number = 0;  // in the chain
    SharedMessage message;
};

// A rendition that at least one session wants.
struct Subscription {
    Rendition rendition;
    bool newcomer = false;  // a session has had no frame yet
    bool lost = false;      // a session has lost the chain
};

}  // namespace spherule::codec
