// Sets whether each group is active: whether it or a group around it holds an awake sphere. These groups hold all
// spheres that an awake sphere touches, and all neighbours of those. The solvers skip inactive groups.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/grid.h"

BUFFER(readonly, uint, counters)
BUFFER(readonly, uint, activeGroup)
BUFFER(restrict, uvec4, groupRange)

// Neighbours on a ring of `count` places.
uint lower(uint at, uint count) {
    return at == 0u ? count - 1u : at - 1u;
}

uint upper(uint at, uint count) {
    return at + 1u == count ? 0u : at + 1u;
}

KERNEL(params.groups * 8u) {
    uvec4 range = groupRange[invocation];
    if (listedPairs(range) == 0u) return;  // no pairs
    uvec4 cells = cellsOf(levelOfGroup(invocation));
    uint first = firstCell(cells) / 8u;
    uint gx = cells.x / 2u;
    uint gy = cells.y / 2u;
    uint gz = cells.z / 2u;
    uint substep = counters[COUNTER_SUBSTEPS];
    uint row = (invocation - first) / gx;
    uint x = invocation - first - row * gx;
    uint west = lower(x, gx);
    uint east = upper(x, gx);
    uint y = lower(row / gz, gy);
    uint below = lower(row % gz, gz);
    bool anyActive = false;
    for (uint k = 0u; k < 3u && !anyActive; ++k) {
        uint z = below;
        for (uint j = 0u; j < 3u && !anyActive; ++j) {
            uint start = first + (y * gz + z) * gx;
            anyActive = activeGroup[start + west] == substep || activeGroup[start + x] == substep ||
                        activeGroup[start + east] == substep;
            z = upper(z, gz);
        }
        y = upper(y, gy);
    }
    groupRange[invocation] = uvec4(firstPair(range), listedPairs(range), 0u, anyActive ? 1u : 0u);
}
