// Sets the bits of each bundle: whether one of its blocks or a block around it holds an awake sphere, and one that may wake
// others. Active bundles have all pairs of the awake spheres, and all pairs of their neighbours. The solvers skip the others.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/grid.h"
#include "shared/bundles.h"

BUFFER(readonly, uint, counters)
BUFFER(readonly, uint, activeBlock)
BUFFER(readonly, uint, wakerBlock)
BUFFER(restrict, uint, bundles)

// Place `k` (0 .. 2) of a place and its two neighbours on a ring of `count` places.
uint around(uint at, uint k, uint count) {
    uint shifted = at + k;
    if (shifted == 0u) return count - 1u;
    return shifted - 1u == count ? 0u : shifted - 1u;
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
    for (uint part = 0u; part < BLOCKS_PER_BUNDLE; ++part) {
        BlockPlace block = blockOfBundle(invocation, level, part);
        for (uint k = THREAD; k < 27u && block.exists && bits != (ACTIVE | WAKERS); k += THREADS) {
            uint x = around(block.x, k % 3u, cells.x / 4u);
            uint y = around(block.y, k / 3u % 3u, cells.y / 4u);
            uint z = around(block.z, k / 9u, cells.z / 4u);
            uint number = blockNumber(cells, x, y, z);
            if (activeBlock[number] != substep) continue;
            bits = bits | ACTIVE;
            if (wakerBlock[number] == substep) bits = bits | WAKERS;
        }
    }
    if (bits != 0u) atomicOr(found, bits);
    BARRIER
    if (FIRST_THREAD) bundles[invocation * BUNDLE_WORDS + 2u] = found;
}
