// If there is no room for all pairs, no group has a list. Otherwise the groups that find room would depend on the
// device's order of execution.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(coherent, uint, counters)
BUFFER(restrict, uvec4, groupRange)

KERNEL(params.groups * 8u) {
    if (counters[COUNTER_PAIRS] <= params.pairCapacity || groupRange[invocation].y == 0u) return;
    atomicAdd(counters[COUNTER_UNLISTED], 1u);
    groupRange[invocation] = uvec4(counters[COUNTER_REBUILDS], UNLISTED, 0u, 1u);
}
