#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

namespace spherule::encode {

// Returns the indices of `positions` (m; w is ignored) in the order of a Morton curve: neighbours in the result are
// near each other in space. The curve has 2^16 cells per axis over the cube around the finite positions. A non-finite
// coordinate counts as an edge of the cube. Any thread.
std::vector<std::uint32_t> mortonOrder(std::span<const glm::vec4> positions);

}  // namespace spherule::encode
