// Writes each sphere's present slot to its place in cell order.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/grid.h"

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, readonly, uint, cellStart, CellBlock)
BUFFER(2, readonly, uint, place, PlaceBlock)
BUFFER(3, writeonly, uint, order, OrderBlock)

KERNEL(params.spheres) {
    order[cellStart[cellOf(position[invocation])] + place[invocation]] = invocation;
}
