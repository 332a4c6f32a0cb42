#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/result.h"
#include "spherule/v1/frame.pb.h"

// The order of spheres in encoded frames, as a message. Any thread.
namespace spherule::codec {

// `ids`: by position in the frame, each below 2^24.
v1::Order orderMessage(std::uint32_t epoch, std::uint32_t number, std::span<const std::uint32_t> ids);

// Returns the ids by position in the frame. The order may be hostile: Input unless it is a permutation of
// 0 .. spheres - 1.
Result<std::vector<std::uint32_t>> idsOf(const v1::Order& order, std::uint32_t spheres);

}  // namespace spherule::codec
