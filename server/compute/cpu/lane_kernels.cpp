// Compiled once for each number of lanes: CMakeLists.txt sets SPHERULE_LANES, SPHERULE_PRECISION and SPHERULE_TABLE.
#include "compute/cpu/vectors.h"

#include "compute/cpu/lane_rows.h"

#define SPHERULE_REAL float
#include "compute/cpu/glue.h"

#include "compute/cpu/lane_kernels.h"

namespace spherule::compute::cpu {

std::span<const Entry> SPHERULE_TABLE() {
    return SPHERULE_PRECISION::all;
}

}  // namespace spherule::compute::cpu
