// If there is no room for all pairs, none of the bundles has a list, and the solvers walk the cells themselves. Otherwise
// the bundles that find room would depend on the device's order of execution.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(coherent, uint, counters)
BUFFER(writeonly, uint, bundles)
BUFFER(readonly, uvec4, dispatchSizes)
BUFFER(writeonly, uvec4, dispatchArgs)

#include "shared/movers.h"

KERNEL(params.bundles) {
    uint bundle = firstBuiltBundle() + invocation;
    if (bundle >= params.bundles) return;
    if (counters[COUNTER_PAIRS] <= counters[COUNTER_PAIR_LIMIT] &&
        counters[COUNTER_CANDIDATES] <= params.pairCapacity) {
        if (invocation == 0u) dispatchArgs[LAUNCH_UNLISTED] = uvec4(0u, 1u, 1u, 0u);
        return;
    }
    atomicAdd(counters[COUNTER_UNLISTED], 1u);
    if (invocation == 0u) atomicOr(counters[COUNTER_REBUILD], LISTS_MISSING);
    // The lists of all spheres may have room for these pairs.
    if (invocation == 0u && moversAlone()) atomicOr(counters[COUNTER_REBUILD], REBUILD_DUE | REBUILD_ALL);
    bundles[bundle * BUNDLE_WORDS] = counters[COUNTER_REBUILDS];
    bundles[bundle * BUNDLE_WORDS + 1u] = UNLISTED;
    if (invocation == 0u) dispatchArgs[LAUNCH_UNLISTED] = dispatchSizes[LAUNCH_UNLISTED];
}
