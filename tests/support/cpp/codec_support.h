#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "compute/device.h"
#include "encode/column_encoder.h"

namespace spherule::codec {

using Bytes = std::vector<std::byte>;
using Positions = std::vector<glm::vec4>;

// An encoder with its own positions, in slots that are a permutation of the ids. Throws errors as exceptions.
class Encoder {
  public:
    Encoder(const std::string& device, std::uint32_t spheres, double quantum = 1, glm::vec3 origin = {});
    Encoder(const std::string& device, std::uint32_t spheres, const encode::ColumnEncoder::Grid& grid);

    void setOrder(const std::vector<std::uint32_t>& order) { context_->setOrder(order); }
    Bytes begin(const Positions& byId);
    Bytes next(const Positions& byId);
    Bytes join();

    [[nodiscard]] encode::ColumnEncoder& frames() { return *encoder_; }
    [[nodiscard]] encode::ColumnSource put(const Positions& byId);

  private:
    std::unique_ptr<compute::Device> device_;
    std::unique_ptr<encode::EncoderContext> context_;
    std::unique_ptr<encode::ColumnEncoder> encoder_;
    std::unique_ptr<compute::Buffer> position_, slotOf_;
    std::vector<std::uint32_t> slots_;  // by id
};

// Returns the grid position that the encoder must produce.
glm::ivec3 onGrid(glm::vec4 position, double quantum = 1, glm::vec3 origin = {});
std::vector<glm::ivec3> onGrid(const Positions& positions);

// Returns positions with these grid positions, for a quantum of 1. Each must be exact in float32.
Positions positionsAt(const std::vector<glm::ivec3>& cells);

// Generates frames with all kinds of motion, one kind per group of some hundred spheres. They rest, creep one by one,
// fly, slow down, jitter by 1 to 2^24 cells, or jump.
class Motion {
  public:
    explicit Motion(std::uint32_t spheres, std::uint64_t seed = 1);
    const std::vector<glm::ivec3>& next();

  private:
    std::uint64_t random_;
    std::uint32_t frame_ = 0;
    std::vector<glm::ivec3> cells_, steps_;
    std::uint32_t draw(std::uint32_t below);
    glm::ivec3 draw(std::uint32_t x, std::uint32_t y, std::uint32_t z);
};

}  // namespace spherule::codec
