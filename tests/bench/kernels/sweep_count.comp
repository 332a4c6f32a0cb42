// Counting sort along x, first part: counts the spheres per key. Each sphere stores its place among equal keys.
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
