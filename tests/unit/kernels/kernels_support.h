#pragma once

#include <array>
#include <initializer_list>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "compute/cpu/kernels.h"

// Runs kernels, compiled as C++, by their file names.
namespace spherule::kernels {

using glm::uvec2;
using glm::uvec4;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;

// The structures and constants of shaders/shared/layout.h.
namespace layout {
#include "shared/layout.h"
}

constexpr std::uint64_t allFeatures = ~std::uint64_t{0};

// A buffer of a kernel, in any vector.
struct Slot {
    template <class T>
    Slot(std::string_view buffer, std::vector<T>& values) : name(buffer), data(values.data()) {}
    std::string_view name;
    void* data;
};

struct Launch {
    const layout::Parameters* parameters = nullptr;
    uint phase = 0;
    std::uint64_t features = 0;
    unsigned lanes = 1;  // of kernels that have lanes
};

// Binds the buffers that the kernel declares; `slots` may have more. Throws std::out_of_range if the kernel or a buffer
// does not exist.
void launch(std::string_view kernel, std::span<const Slot> slots, const Launch& how);
inline void launch(std::string_view kernel, std::initializer_list<Slot> slots, const Launch& how) {
    launch(kernel, std::span(slots.begin(), slots.size()), how);
}

std::vector<std::string_view> kernelNames();

// Replaces values with their exclusive prefix sums, by the three scan kernels with two levels of blocks.
void prefixSum(std::vector<uint>& values);

}  // namespace spherule::kernels
