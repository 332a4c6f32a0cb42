#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "codec/format.h"

namespace spherule::codec {

// The header of one block of a frame. Offsets are in units of 16 bits within `words`.
class Block {
  public:
    // Reads the header at `unit`. Returns false when the block extends beyond the unit `end`.
    bool read(std::span<const std::uint32_t> words, std::size_t unit, std::size_t end);

    [[nodiscard]] Mode mode() const { return mode_; }
    [[nodiscard]] Predictor predictor() const { return predictor_; }
    [[nodiscard]] std::size_t end() const { return end_; }  // first unit after the block

    // Writes the new positions of the block's 64 spheres to `before`. `words` must have one more word after the block.
    // `turns`: as in FrameHead.
    void decode(const std::uint32_t* words, const glm::uvec3& turns, const glm::ivec3* newest,
                glm::ivec3* before) const;

  private:
    bool readMask(std::span<const std::uint32_t> words, std::size_t unit, std::size_t end);
    void readBase(std::span<const std::uint32_t> words, std::size_t unit);
    [[nodiscard]] std::size_t valueBits() const;
    void readValues(const std::uint32_t* words, std::array<std::uint32_t, blockValues>& values) const;

    Mode mode_{};
    Predictor predictor_{};
    std::array<std::array<std::uint8_t, runsPerAxis>, 3> changed_{};  // mode Mask: one bit per value, by axis and run
    std::array<std::array<std::uint8_t, runsPerAxis>, 3> width_{};    // bits, by axis and run
    std::array<std::uint32_t, 3> base_{};
    std::size_t values_ = 0;  // bit offset of the values
    std::size_t end_ = 0;
};

}  // namespace spherule::codec
