// Counting sort along x, first part: spheres per key; a sphere keeps the place it drew.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "sweep.h"

BUFFER(readonly, vec4, position)
BUFFER(coherent, uint, keyStart)
BUFFER(writeonly, uint, place)

KERNEL(params.spheres) {
    place[invocation] = atomicAdd(keyStart[keyOf(position[invocation].x)], 1u);
}
