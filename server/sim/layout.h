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

// The 32-bit words of a struct of shaders/shared/`file`, in turn, as compute::Device::createBuffer wants them: 'r' a
// real number, 'u' an unsigned integer. Read from the text of the file. Throws std::logic_error for a struct that is
// not there and for a member that would not lie in a uniform block (std140) as it lies in C++: a vector must begin at a
// multiple of 16 bytes.
std::string wordsOf(std::string_view structName, std::string_view file = "layout.h");

}  // namespace spherule::sim::layout
