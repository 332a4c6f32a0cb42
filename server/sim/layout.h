#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
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

static_assert(sizeof(vec4) == 16 && sizeof(uvec4) == 16);
static_assert(sizeof(Parameters) % 16 == 0, "std140");

// Returns the types of the 32-bit words of a struct in shaders/shared/`file`, for compute::Device::createBuffer: 'r' a
// real number, 'u' an unsigned integer. Reads them from the text of the file. Throws std::logic_error if there is no
// such struct, or if a vector in it does not begin at a multiple of 16 bytes. The layout in a uniform block (std140)
// would then differ from C++.
std::string wordsOf(std::string_view structName, std::string_view file = "layout.h");

}  // namespace spherule::sim::layout
