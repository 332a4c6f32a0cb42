// If there is no room for all pairs, no bundle has a list, and the solvers walk the cells themselves. Otherwise the
// bundles that find room would depend on the device's order of execution.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(coherent, uint, counters)
BUFFER(writeonly, uint, bundles)
BUFFER(readonly, uvec4, dispatchSizes)
BUFFER(writeonly, uvec4, dispatchArgs)

KERNEL(params.bundles) {
    if (max(counters[COUNTER_PAIRS], counters[COUNTER_CANDIDATES]) <= params.pairCapacity) {
        if (invocation == 0u) dispatchArgs[LAUNCH_UNLISTED] = uvec4(0u, 1u, 1u, 0u);
        return;
    }
    atomicAdd(counters[COUNTER_UNLISTED], 1u);
    if (invocation == 0u) atomicOr(counters[COUNTER_REBUILD], LISTS_MISSING);
    bundles[invocation * BUNDLE_WORDS] = counters[COUNTER_REBUILDS];
    bundles[invocation * BUNDLE_WORDS + 1u] = UNLISTED;
    if (invocation == 0u) dispatchArgs[LAUNCH_UNLISTED] = dispatchSizes[LAUNCH_UNLISTED];
}
