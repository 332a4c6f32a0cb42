#pragma once

#include <cstdint>
#include <optional>

#include <glm/vec3.hpp>

#include "sim/state.h"

namespace spherule::sim {

// Returns the id of the first sphere that a ray hits; nullopt if there is none. `origin` is relative to the bounds'
// centre, `direction` has unit length. `periods`: as Bounds::periods() returns them. A sphere that reaches across a
// seam is hit on both sides.
std::optional<std::uint32_t> firstHit(const State& state, glm::dvec3 origin, glm::dvec3 direction,
                                      const glm::dvec3& periods = {});

}  // namespace spherule::sim
