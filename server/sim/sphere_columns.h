#pragma once

#include <cstdint>
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

}  // namespace spherule::sim
