// Before lists of movers alone are built: adds the awake spheres that are no longer near their list reference, and the
// new spheres, to the movers. Marks the blocks whose lists may have their pairs.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/bundles.h"
#include "shared/cell_of.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, vec4, listReference)
BUFFER(coherent, uint, counters)
BUFFER(writeonly, uint, moverSlots)
BUFFER(restrict, uint, isMover)
BUFFER(coherent, uint, leftBlock)  // the last lists, by COUNTER_REBUILDS, for which a sphere left the block

#include "shared/leaving.h"

KERNEL(params.spheres) {
    vec4 v = velocity[invocation];
    if (!isAwake(v) || isMover[invocation] != 0u) return;
    vec4 reference = listReference[invocation];
    vec3 since = vec3(position[invocation]) - vec3(reference);
    if (mostMoved(since, vec3(v)) <= LEAVES * params.rebuildMove) return;
    uint mover = atomicAdd(counters[COUNTER_MOVERS], 1u);
    if (mover >= counters[COUNTER_MOVER_ROOM]) {
        atomicOr(counters[COUNTER_REBUILD], REBUILD_DUE | REBUILD_ALL);
        return;
    }
    moverSlots[mover] = invocation;
    isMover[invocation] = 1u;
    // The blocks that are no farther than a cell have the lists with its pairs.
    vec3 cells = inverseCellsOf(0u);
    vec3 width = vec3(1.0f / cells.x, 1.0f / cells.y, 1.0f / cells.z);
    for (uint k = 0u; k < 8u; ++k) {
        vec3 side = vec3((k & 1u) != 0u ? width.x : -width.x, (k & 2u) != 0u ? width.y : -width.y,
                         (k & 4u) != 0u ? width.z : -width.z);
        atomicExchange(leftBlock[blockAt(vec3(reference) + side, 0u)], counters[COUNTER_REBUILDS]);
    }
}
