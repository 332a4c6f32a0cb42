// Counting sort along x, last part: writes the state in its new order. Spheres with the same key are in any order.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "sweep.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, uint, keyStart)
BUFFER(readonly, uint, place)
BUFFER(writeonly, vec4, sortedPosition)
BUFFER(writeonly, vec4, sortedVelocity)

KERNEL(params.spheres) {
    vec4 x = position[invocation];
    uint to = keyStart[keyOf(x.x)] + place[invocation];
    sortedPosition[to] = x;
    sortedVelocity[to] = velocity[invocation];
}
