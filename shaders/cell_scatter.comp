// Writes the present slot of each sphere to its place in cell order.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(readonly, uint, cellOfSphere)  // another kernel might round the cell of a sphere at a border to the other side
BUFFER(readonly, uint, cellStart)
BUFFER(readonly, uint, rankInCell)
BUFFER(writeonly, uint, cellOrder)

KERNEL(params.spheres) {
    cellOrder[cellStart[cellOfSphere[invocation]] + rankInCell[invocation]] = invocation;
}
