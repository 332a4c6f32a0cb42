// Where there is no room for all pairs, no group has a list: which ones found room would depend on the order in which the
// device happened to run.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(0, coherent, uint, counters, CounterBlock)
BUFFER(1, restrict, uvec4, span, SpanBlock)

KERNEL(params.groups * 8u) {
    if (counters[COUNTER_PAIRS] <= params.pairCapacity || span[invocation].y == 0u) return;
    atomicAdd(counters[COUNTER_UNLISTED], 1u);
    span[invocation] = uvec4(counters[COUNTER_REBUILDS], UNLISTED, 0u, 1u);
}
