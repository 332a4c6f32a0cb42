#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/result.h"

// The decoder of docs/codec.md. What it is given may be hostile.
namespace spherule::codec {

struct FrameHead {
    std::uint32_t spheres = 0;
    std::uint32_t number = 0;
    bool keyframe = false;
    std::optional<std::uint32_t> hash;
};

// Of the frame's first bytes; Input where they are none.
Result<FrameHead> headOf(std::span<const std::byte> frame);

// Of spheres in the codec's order, on the grid: what a frame's hash is compared with.
std::uint32_t hashOf(std::span<const glm::ivec3> positions);

// One chain of frames. Used by one thread at a time. It allocates for its spheres, and for the longest frame that it
// was given.
class Decoder {
  public:
    explicit Decoder(std::uint32_t spheres);  // at least 1

    // Takes the next frame. Input, with where in the frame, for one that is malformed, of other spheres, or does not
    // follow the frame before; after that and after a hash that differs it wants a keyframe, and keeps the positions it
    // had (after a hash that differs: those of the frame).
    Result<FrameHead> apply(std::span<const std::byte> frame);

    [[nodiscard]] std::span<const glm::ivec3> newest() const { return {newest_.data(), spheres_}; }
    // Of the frame before; only after a delta frame.
    [[nodiscard]] std::span<const glm::ivec3> before() const { return {before_.data(), spheres_}; }
    [[nodiscard]] bool wantsKeyframe() const { return history_ == 0; }

  private:
    Result<void> checkOrder(const FrameHead& head) const;
    Result<void> decode(const FrameHead& head, std::size_t words);
    Result<void> decodeChunk(const FrameHead& head, std::uint32_t chunk, std::size_t begin, std::size_t end);

    std::uint32_t spheres_;
    std::vector<glm::ivec3> newest_, before_;  // whole blocks
    std::vector<std::uint32_t> words_;         // of the frame, and two more, so that reading bits may look ahead
    std::uint32_t number_ = 0;
    unsigned history_ = 0;  // states that are known, at most 2
};

}  // namespace spherule::codec
