// Marks the groups that hold a sphere that is awake, with the number of the substep.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/grid.h"

BUFFER(0, readonly, vec4, velocity, VelocityBlock)
BUFFER(1, readonly, vec4, anchor, AnchorBlock)  // which cell the lists have it in
BUFFER(2, readonly, uint, counters, CounterBlock)
BUFFER(3, coherent, uint, stirred, StirredBlock)

KERNEL(params.spheres) {
    if (velocity[invocation].w < 0.0f) return;
    atomicExchange(stirred[groupAt(vec3(anchor[invocation]))], counters[COUNTER_SUBSTEPS]);
}
