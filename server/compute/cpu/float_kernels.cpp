#define SPHERULE_REAL float
#define SPHERULE_PRECISION single_precision
#include "compute/cpu/vectors.h"

#include "compute/cpu/glue.h"

#include "compute/cpu/all_kernels.h"

namespace spherule::compute::cpu {

std::span<const Entry> floatKernels() {
    return single_precision::all;
}

}  // namespace spherule::compute::cpu
