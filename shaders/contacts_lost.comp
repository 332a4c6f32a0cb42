// After the contacts are restored: if some of them are in no list, launches the kernels that add up what the others
// hold.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(readonly, uint, counters)
BUFFER(readonly, uvec4, dispatchSizes)
BUFFER(writeonly, uvec4, dispatchArgs)

KERNEL(1u) {
    if (counters[COUNTER_CARRIED] == counters[COUNTER_RESTORED]) return;
    dispatchArgs[LAUNCH_LOST_SPHERES] = dispatchSizes[LAUNCH_LOST_SPHERES];
    dispatchArgs[LAUNCH_LOST_COLOUR] = dispatchSizes[LAUNCH_LOST_COLOUR];
}
