#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

namespace spherule::sim {

// Indices of `positions` (m; w does not count) along a Morton curve of 2^16 cells per axis over the cube around the
// finite ones: neighbours in the result are neighbours in space. Others come as if they were at its corner. Any thread.
std::vector<std::uint32_t> mortonOrder(std::span<const glm::vec4> positions);

}  // namespace spherule::sim
