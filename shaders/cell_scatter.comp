// Writes the present slot of each sphere to its place in cell order.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/bundles.h"
#include "shared/cell_of.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, uint, cellStart)
BUFFER(readonly, uint, rankInCell)
BUFFER(writeonly, uint, cellOrder)

KERNEL(params.spheres) {
    cellOrder[cellStart[cellOf(position[invocation])] + rankInCell[invocation]] = invocation;
}
