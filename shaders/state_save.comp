// Copies the state, which the gather then reads while it writes the state anew.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, readonly, vec4, velocity, VelocityBlock)
BUFFER(2, readonly, vec4, before, BeforeBlock)
BUFFER(3, readonly, uint, id, IdBlock)
BUFFER(4, writeonly, vec4, saved, SavedBlock)
BUFFER(5, writeonly, uint, savedId, SavedIdBlock)

KERNEL(params.spheres) {
    saved[invocation] = position[invocation];
    saved[params.spheres + invocation] = velocity[invocation];
    if (HAS(BEFORE)) saved[2u * params.spheres + invocation] = before[invocation];
    savedId[invocation] = id[invocation];
}
