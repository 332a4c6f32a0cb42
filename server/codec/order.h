#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/result.h"
#include "spherule/v1/frame.pb.h"

// The order of the codec's spheres, as it travels. Any thread.
namespace spherule::codec {

// `ids`: by place in the codec, each below 2^24.
v1::Order orderMessage(std::uint32_t epoch, std::uint32_t number, std::span<const std::uint32_t> ids);

// The ids of an order that may be hostile; Input where they are no permutation of 0 .. spheres - 1.
Result<std::vector<std::uint32_t>> idsOf(const v1::Order& order, std::uint32_t spheres);

}  // namespace spherule::codec
