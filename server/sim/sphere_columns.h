#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/vec4.hpp>

#include "sim/array.h"

namespace spherule::sim {

// The columns of the spheres' state: the rows of sim/sphere_columns.def.
struct SphereColumns {
#define SPHERE_COLUMN(member, Type, ArrayName, value) std::vector<Type> member;
#include "sim/sphere_columns.def"
#undef SPHERE_COLUMN
};

// Calls `visit` with the member and the array of each column, in the order of the rows.
template <class Visit>
constexpr void forEachColumn(Visit visit) {
#define SPHERE_COLUMN(member, Type, ArrayName, value) visit(&SphereColumns::member, Array::ArrayName);
#include "sim/sphere_columns.def"
#undef SPHERE_COLUMN
}

// The arrays that hold the state of the spheres, each with the array that keeps a copy of it on the device.
constexpr std::array keptArrays{
#define SPHERE_COLUMN(member, Type, ArrayName, value) std::pair{Array::ArrayName, Array::Kept##ArrayName},
#include "sim/sphere_columns.def"
#undef SPHERE_COLUMN
    std::pair{Array::IdAndMaterial, Array::KeptIdAndMaterial}, std::pair{Array::Images, Array::KeptImages}};

// Returns the array that keeps a copy of `array`.
constexpr Array keptOf(Array array) {
    for (const auto& [from, kept] : keptArrays)
        if (from == array) return kept;
    return Array::Count;
}

}  // namespace spherule::sim
