#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/result.h"

// Decoder of docs/codec.md. The input may be hostile.
namespace spherule::codec {

struct FrameHead {
    std::uint32_t spheres = 0;
    std::uint32_t number = 0;
    bool keyframe = false;
    std::optional<std::uint32_t> hash;
    glm::uvec3 turns{};                       // per axis: coordinates are counted modulo this number; 0: they are not
    [[nodiscard]] std::size_t words() const;  // before the table of chunks
};

// Parses the first bytes of a frame. Input if they are no head.
Result<FrameHead> headOf(std::span<const std::byte> frame);

// Hash of grid positions in codec order; a frame may carry it to detect decoding errors.
std::uint32_t hashOf(std::span<const glm::ivec3> positions);

// Decodes one chain of frames. Used by one thread at a time. Allocates memory for the spheres and for the longest frame
// so far.
class Decoder {
  public:
    explicit Decoder(std::uint32_t spheres);  // at least 1

    // Decodes the next frame. Input, with the place in the frame, if it is malformed, has another number of spheres,
    // does not follow the previous frame, or its hash differs. After an error a keyframe is needed, and
    // newest() still has the previous frame; if only the hash differs, it has this frame.
    Result<FrameHead> apply(std::span<const std::byte> frame);

    // Positions of the newest frame, in codec order, on the grid.
    [[nodiscard]] std::span<const glm::ivec3> newest() const { return {newest_.data(), spheres_}; }
    // Per axis, the grid cells in the length of a periodic axis, modulo which newest() counts; 0: not periodic.
    [[nodiscard]] const glm::uvec3& turns() const { return turns_; }
    // Positions of the previous frame; valid only after a delta frame.
    [[nodiscard]] std::span<const glm::ivec3> before() const { return {before_.data(), spheres_}; }
    [[nodiscard]] bool wantsKeyframe() const { return history_ == 0; }

  private:
    Result<void> checkOrder(const FrameHead& head) const;
    Result<void> decode(const FrameHead& head, std::size_t words);
    Result<void> decodeChunk(const FrameHead& head, std::uint32_t chunk, std::size_t begin, std::size_t end);

    std::uint32_t spheres_;
    std::vector<glm::ivec3> newest_, before_;  // whole blocks
    std::vector<std::uint32_t> words_;         // of the frame, and two more, because reading bits looks ahead
    std::uint32_t number_ = 0;
    glm::uvec3 turns_{};    // of the chain
    unsigned history_ = 0;  // number of known states, at most 2
};

}  // namespace spherule::codec
