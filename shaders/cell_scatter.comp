// Writes the present slot of each sphere to its place in cell order.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(readonly, uint, cellOfSphere)  // another kernel might round the cell of a sphere at a border to the other side
BUFFER(readonly, uint, cellStart)
BUFFER(readonly, uint, rankInCell)
BUFFER(writeonly, uint, cellOrder)
BUFFER(readonly, uint, counters)
BUFFER(readonly, uint, moverSlots)

#include "shared/movers.h"

KERNEL(params.spheres) {
    if (invocation >= builtSpheres()) return;
    uint slot = moversAlone() ? moverSlots[invocation] : invocation;
    cellOrder[cellStart[cellOfSphere[invocation]] + rankInCell[invocation]] = slot;
}
