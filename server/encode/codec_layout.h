#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/vec4.hpp>

// The buffer layouts of shaders/shared/codec_layout.h, as C++.
namespace spherule::encode::codec_layout {

using glm::uvec4;
using glm::vec4;
using uint = std::uint32_t;

#include "shared/codec_layout.h"

static_assert(sizeof(Parameters) == 112);
static_assert(offsetof(Parameters, spheres) == 80);

}  // namespace spherule::encode::codec_layout
