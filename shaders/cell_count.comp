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

KERNEL(params.spheres) {
    uint cell = cellOf(position[invocation]);
    cellOfSphere[invocation] = cell;
    rankInCell[invocation] = atomicAdd(cellStart[cell], 1u);
}
