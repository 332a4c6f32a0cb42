#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

// The buffer layouts of shaders/shared/layout.h, as C++.
namespace spherule::sim::layout {

using glm::uvec4;
using glm::vec4;
using uint = std::uint32_t;

#include "shared/layout.h"

// std140 puts a uniform block's vectors on multiples of 16 and packs scalars; the struct keeps to it without padding.
static_assert(sizeof(vec4) == 16 && sizeof(uvec4) == 16);
static_assert(offsetof(Parameters, cells) == 64);
static_assert(offsetof(Parameters, substep) == 80);
static_assert(offsetof(Parameters, spheres) == 128);
static_assert(sizeof(Parameters) == 160);
static_assert(sizeof(Obstacle) == 32);
static_assert(sizeof(SphereStatistics) == 64);

}  // namespace spherule::sim::layout
