#pragma once

#include <cstdint>
#include <optional>

#include <glm/vec3.hpp>

#include "sim/state.h"

namespace spherule::sim {

// The first sphere that a ray meets; origin relative to the bounds' centre, direction of unit length.
std::optional<std::uint32_t> firstHit(const State& state, glm::dvec3 origin, glm::dvec3 direction);

}  // namespace spherule::sim
