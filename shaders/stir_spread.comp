// Tells each group whether it stirs: whether any sphere is awake in it or in the groups around it, which hold all that one
// awake sphere touches and what those touch in turn. The solvers pass over groups that do not.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(0, readonly, uint, counters, CounterBlock)
BUFFER(1, readonly, uint, stirred, StirredBlock)
BUFFER(2, restrict, uvec4, span, SpanBlock)

KERNEL(params.groups * 8u) {
    uint gx = params.cells.x / 2u;
    uint gy = params.cells.y / 2u;
    uint gz = params.cells.z / 2u;
    // One less, on the torus; then three in each direction.
    uint x = (invocation + gx - 1u) % gx;
    uint y = (invocation / gx + gy - 1u) % gy;
    uint z = (invocation / (gx * gy) + gz - 1u) % gz;
    uint substep = counters[COUNTER_SUBSTEPS];
    uint stirs = 0u;
    for (uint k = 0u; k < 27u && stirs == 0u; ++k) {
        uint around = (((z + k / 9u) % gz) * gy + (y + (k / 3u) % 3u) % gy) * gx + (x + k % 3u) % gx;
        stirs = stirred[around] == substep ? 1u : 0u;
    }
    uvec4 mine = span[invocation];
    span[invocation] = uvec4(mine.x, mine.y, 0u, stirs);
}
