#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace spherule::compute::cpu::double_precision {

using vec3 = glm::dvec3;
using vec4 = glm::dvec4;

// The kernels' literals are float, and GLM requires a vector and a number of the same type.
inline vec3 operator*(const vec3& v, float factor) {
    return v * static_cast<double>(factor);
}

}  // namespace spherule::compute::cpu::double_precision

#define SPHERULE_REAL double
#define SPHERULE_PRECISION double_precision
#include "compute/cpu/glue.h"

#define float double
#include "compute/cpu/all_kernels.h"
#undef float

namespace spherule::compute::cpu {

std::span<const Entry> doubleKernels() {
    return double_precision::all;
}

}  // namespace spherule::compute::cpu
