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
