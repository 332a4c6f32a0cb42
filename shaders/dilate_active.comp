// Sets whether each bundle is active: whether one of its blocks or a block around it holds an awake sphere. Active
// bundles have all pairs of the awake spheres, and all pairs of their neighbours. The solvers skip the others.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/grid.h"
#include "shared/bundles.h"

BUFFER(readonly, uint, counters)
BUFFER(readonly, uint, activeBlock)
BUFFER(restrict, uint, bundles)

// Place `k` (0 .. 2) of a place and its two neighbours on a ring of `count` places.
uint around(uint at, uint k, uint count) {
    uint shifted = at + k;
    if (shifted == 0u) return count - 1u;
    return shifted - 1u == count ? 0u : shifted - 1u;
}

SHARED(uint, anyAwake)

BUNDLE_KERNEL(params.bundles) {
    if (bundles[invocation * BUNDLE_WORDS + 1u] == 0u) return;  // no pairs
    uint level = levelOfBundle(invocation);
    uvec4 cells = cellsOf(level);
    uint substep = counters[COUNTER_SUBSTEPS];
    if (FIRST_THREAD) anyAwake = 0u;
    BARRIER
    bool awake = false;
    for (uint part = 0u; part < BLOCKS_PER_BUNDLE && !awake; ++part) {
        BlockPlace block = blockOfBundle(invocation, level, part);
        for (uint k = THREAD; k < 27u && block.exists && !awake; k += THREADS) {
            uint x = around(block.x, k % 3u, cells.x / 4u);
            uint y = around(block.y, k / 3u % 3u, cells.y / 4u);
            uint z = around(block.z, k / 9u, cells.z / 4u);
            awake = activeBlock[blockNumber(cells, x, y, z)] == substep;
        }
    }
    if (awake) atomicOr(anyAwake, 1u);
    BARRIER
    if (FIRST_THREAD) bundles[invocation * BUNDLE_WORDS + 2u] = anyAwake;
}
