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

// Runs kernels by the name of their file, as C++.
namespace spherule::kernels {

using glm::uvec2;
using glm::uvec4;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;

// As shaders/shared/layout.h has it, with its constants.
namespace layout {
#include "shared/layout.h"
}

constexpr uint allFeatures = ~0U;

// Any vector is a buffer.
struct Slot {
    template <class T>
    Slot(std::vector<T>& values) : data(values.data()) {}  // NOLINT(google-explicit-constructor)
    void* data;
};

struct Launch {
    const layout::Parameters* parameters = nullptr;
    uint phase = 0;
    uint features = 0;
};

// Throws std::out_of_range for a kernel that is not there.
void launch(std::string_view kernel, std::initializer_list<Slot> slots, const Launch& how);

std::vector<std::string_view> kernelNames();

// Turns values into exclusive prefix sums with the three scan kernels, two levels of blocks deep.
void prefixSum(std::vector<uint>& values);

}  // namespace spherule::kernels
