// Counting sort along x, first part: spheres per key; a sphere keeps the place it drew.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "sweep.h"

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, coherent, uint, keyStart, KeyBlock)
BUFFER(2, writeonly, uint, place, PlaceBlock)

KERNEL(params.spheres) {
    place[invocation] = atomicAdd(keyStart[keyOf(position[invocation].x)], 1u);
}
