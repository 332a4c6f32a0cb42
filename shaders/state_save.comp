// Copies the state, which the gather then reads while it writes the state anew. Sleepers that were flagged wake up.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, readonly, vec4, velocity, VelocityBlock)
BUFFER(2, readonly, vec4, before, BeforeBlock)
BUFFER(3, readonly, uint, label, LabelBlock)
BUFFER(4, writeonly, vec4, saved, SavedBlock)
BUFFER(5, writeonly, uint, savedLabel, SavedLabelBlock)
BUFFER(6, restrict, uint, woken, WokenBlock)

KERNEL(params.spheres) {
    uint to = invocation;
    saved[to] = position[invocation];
    vec4 v = velocity[invocation];
    if (HAS(SLEEP) && woken[invocation] != 0u) {
        woken[invocation] = 0u;
        v = vec4(vec3(v), abs(v.w));
    }
    to = to + params.spheres;
    saved[to] = v;
    if (HAS(BEFORE)) {
        to = to + params.spheres;
        saved[to] = before[invocation];
    }
    if (HAS(FRICTION)) {
        to = to + params.spheres;
        saved[to] = velocity[params.spheres + invocation];
    }
    if (HAS(RESIDUAL)) {
        to = to + params.spheres;
        saved[to] = position[params.spheres + invocation];
    }
    savedLabel[invocation] = label[invocation];
}
