// Counts the spheres of each cell. A sphere's rank is the count before it was added.
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

KERNEL(params.spheres) {
    rankInCell[invocation] = atomicAdd(cellStart[cellOf(position[invocation])], 1u);
}
