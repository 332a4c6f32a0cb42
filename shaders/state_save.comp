// Copies the state, which the gather then reads while it writes the state anew. Sleepers that were flagged wake up.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, readonly, vec4, velocity, VelocityBlock)
BUFFER(2, readonly, vec4, before, BeforeBlock)
BUFFER(3, readonly, uint, id, IdBlock)
BUFFER(4, writeonly, vec4, saved, SavedBlock)
BUFFER(5, writeonly, uint, savedId, SavedIdBlock)
BUFFER(6, restrict, uint, woken, WokenBlock)

KERNEL(params.spheres) {
    saved[invocation] = position[invocation];
    vec4 v = velocity[invocation];
    if (HAS(SLEEP) && woken[invocation] != 0u) {
        woken[invocation] = 0u;
        v = vec4(vec3(v), abs(v.w));
    }
    saved[params.spheres + invocation] = v;
    if (HAS(BEFORE)) saved[2u * params.spheres + invocation] = before[invocation];
    savedId[invocation] = id[invocation];
}
