// Counting sort along x, last part: the state in its new order. Spheres of one key stand in any order.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "sweep.h"

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, readonly, vec4, velocity, VelocityBlock)
BUFFER(2, readonly, uint, keyStart, KeyBlock)
BUFFER(3, readonly, uint, place, PlaceBlock)
BUFFER(4, writeonly, vec4, sortedPosition, SortedPositionBlock)
BUFFER(5, writeonly, vec4, sortedVelocity, SortedVelocityBlock)

KERNEL(params.spheres) {
    vec4 x = position[invocation];
    uint to = keyStart[keyOf(x.x)] + place[invocation];
    sortedPosition[to] = x;
    sortedVelocity[to] = velocity[invocation];
}
