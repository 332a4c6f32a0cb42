// Counts the spheres of each cell; a sphere keeps the place it drew.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/grid.h"

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, coherent, uint, cellStart, CellBlock)
BUFFER(2, writeonly, uint, place, PlaceBlock)

KERNEL(params.spheres) {
    place[invocation] = atomicAdd(cellStart[cellOf(position[invocation])], 1u);
}
