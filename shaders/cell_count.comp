// Finds the cell of each sphere, and counts the spheres of each cell. A sphere's rank is the count before it was added.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/bundles.h"
#include "shared/cell_of.h"

BUFFER(readonly, vec4, position)
BUFFER(coherent, uint, cellStart)
BUFFER(writeonly, uint, rankInCell)
BUFFER(writeonly, uint, cellOfSphere)
BUFFER(readonly, uint, counters)
BUFFER(readonly, uint, moverSlots)

#include "shared/movers.h"

KERNEL(params.spheres) {
    if (invocation >= builtSpheres()) return;
    uint cell = moversAlone() ? cellAtLevel(vec3(position[moverSlots[invocation]]), params.moverLevel)
                              : cellOf(position[invocation]);
    cellOfSphere[invocation] = cell;
    rankInCell[invocation] = atomicAdd(cellStart[cell], 1u);
}
