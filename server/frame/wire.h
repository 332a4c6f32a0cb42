#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/result.h"
#include "scene/scene.h"
#include "spherule/v1/frame.pb.h"

// The codec's one seam: what the device packs (shaders/pack.comp), what a frame carries, what a decoder gives back.
namespace spherule::frame {

constexpr std::uint32_t blockSpheres = 64;  // spheres per packed block
constexpr std::uint32_t blockBytes = blockSpheres * 6;

// The grid for a scene: quantum = max(r_min / 250, 1.5 * longest side / 65535), centred on the bounds, so that there is
// room around the bounds on all sides. Positions are off by at most quantum / 2 per axis.
v1::WireGrid wireGridFor(const scene::Bounds& bounds, double smallestRadius);

// Bytes that the device packs for `count` spheres.
std::size_t packedBytes(std::uint32_t count);

v1::States statesOf(std::span<const std::byte> packed);

// Positions in metres, in id order; an error for a frame whose bytes do not fit its count.
Result<std::vector<glm::dvec3>> positionsOf(const v1::Frame& frame, const v1::WireGrid& grid);

}  // namespace spherule::frame
