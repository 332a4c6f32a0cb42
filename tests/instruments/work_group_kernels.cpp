#define SPHERULE_REAL float
#define SPHERULE_PRECISION in_work_groups
#include "compute/cpu/vectors.h"

#include "compute/cpu/glue.h"

namespace spherule::compute::cpu::in_work_groups {
namespace glue = in_work_groups;
}
#undef SPHERULE_PRECISION
#define SPHERULE_PRECISION in_work_groups::kernels
#include "work_group_glue.h"

#include "compute/cpu/all_kernels.h"

#include "control_kernels.h"

namespace spherule::instruments {

std::span<const Entry> inWorkGroups() {
    return compute::cpu::in_work_groups::kernels::all;
}

std::span<const Entry> controls() {
    return compute::cpu::in_work_groups::kernels::controls;
}

}  // namespace spherule::instruments
