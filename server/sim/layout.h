#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

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
static_assert(offsetof(Parameters, cells) == 208);
static_assert(offsetof(Parameters, substep) == 352);
static_assert(offsetof(Parameters, spheres) == 400);
static_assert(sizeof(Parameters) == 448);
// What the words of these are: 'r' a real number, 'u' an unsigned integer.
constexpr std::string_view parameterWords =
    "rrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrrr"
    "uuuuuuuuuuuuuuuuuuuuuuuuuuuuuuuuuuuu"
    "rrrrrrrrrrrr"
    "uuuuuuuuuuuu";
constexpr std::string_view statisticsWords = "rrrrrrrrrrrrrrrrrrrruuuu";
static_assert(parameterWords.size() * 4 == sizeof(Parameters));
static_assert(parameterWords.find('u') * 4 == offsetof(Parameters, cells));
static_assert(parameterWords.rfind('r') * 4 + 4 == offsetof(Parameters, spheres));
static_assert(statisticsWords.size() * 4 == sizeof(SphereStatistics));
static_assert(statisticsWords.find('u') * 4 == offsetof(SphereStatistics, sleeping));

static_assert(sizeof(Obstacle) == 32 && sizeof(Law) == 32);
static_assert(sizeof(SphereStatistics) == 96);

}  // namespace spherule::sim::layout
