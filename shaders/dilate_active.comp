// Sets the bits of each bundle: whether one of its blocks, or a group of cells around it, holds an awake sphere, and one that
// may wake others. Active bundles have all pairs of the awake spheres, and of those that they wake in this substep: a
// group around a block is two cells wide. The solvers skip the others.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/grid.h"
#include "shared/bundles.h"

BUFFER(readonly, uint, counters)
BUFFER(readonly, uint, activeBlock)
BUFFER(readonly, uint, activeGroup)
BUFFER(readonly, uint, wakerGroup)
BUFFER(restrict, uint, bundles)

// Place `k` of a place and those around it on a ring of `count` places, from the one before it on.
uint around(uint at, uint k, uint count) {
    uint shifted = at + k;
    if (shifted == 0u) return count - 1u;
    return shifted - 1u >= count ? shifted - 1u - count : shifted - 1u;
}

// Returns true if the block or one around it may hold an awake sphere. A GPU has a thread for each group around a block,
// and need not ask.
bool mayBeActive(uvec4 cells, BlockPlace block, uint substep) {
    if (THREADS > 1u) return true;
    for (uint k = 0u; k < 27u; ++k) {
        uint x = around(block.x, k % 3u, cells.x / 4u);
        uint y = around(block.y, k / 3u % 3u, cells.y / 4u);
        uint z = around(block.z, k / 9u, cells.z / 4u);
        if (activeBlock[blockNumber(cells, x, y, z)] == substep) return true;
    }
    return false;
}

SHARED(uint, found)

BUNDLE_KERNEL(params.bundles) {
    if (bundles[invocation * BUNDLE_WORDS + 1u] == 0u) return;  // no pairs
    uint level = levelOfBundle(invocation);
    uvec4 cells = cellsOf(level);
    uint substep = counters[COUNTER_SUBSTEPS];
    if (FIRST_THREAD) found = 0u;
    BARRIER
    uint bits = 0u;
    for (uint part = 0u; part < BLOCKS_PER_BUNDLE && bits != (ACTIVE | WAKERS); ++part) {
        BlockPlace block = blockOfBundle(invocation, level, part);
        if (!block.exists || !mayBeActive(cells, block, substep)) continue;
        // The 2 x 2 x 2 groups of the block, and those around them.
        for (uint k = THREAD; k < 64u && bits != (ACTIVE | WAKERS); k += THREADS) {
            uint x = around(2u * block.x, k % 4u, cells.x / 2u);
            uint y = around(2u * block.y, k / 4u % 4u, cells.y / 2u);
            uint z = around(2u * block.z, k / 16u, cells.z / 2u);
            uint group = groupNumber(cells, x, y, z);
            if (activeGroup[group] != substep) continue;
            bits = bits | ACTIVE;
            if (wakerGroup[group] == substep) bits = bits | WAKERS;
        }
    }
    if (bits != 0u) atomicOr(found, bits);
    BARRIER
    if (!FIRST_THREAD) return;
    if (found != 0u && counters[COUNTER_RESTING] != 0u) found = found | SLEEPERS;
    bundles[invocation * BUNDLE_WORDS + 2u] = found;
}
