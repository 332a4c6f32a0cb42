// Counts the spheres whose centre is in a sink, at the end of a step. The host removes them.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/wrap.h"

BUFFER(readonly, vec4, position)
BUFFER(coherent, uint, counters)

KERNEL(params.spheres) {
    vec3 p = vec3(position[invocation]);
    if (HAS(PERIODIC)) p = wrapped(p);
    for (uint k = 0u; k < MOST_SINKS && float(k) < params.sinkMin[0].w; ++k) {
        vec4 low = params.sinkMin[k];
        vec4 high = params.sinkMax[k];
        if (p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z) {
            atomicAdd(counters[COUNTER_SUNK], 1u);
            return;
        }
    }
}
