// Writes the state in cell order.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(0, writeonly, vec4, position, PositionBlock)
BUFFER(1, writeonly, vec4, velocity, VelocityBlock)
BUFFER(2, writeonly, vec4, before, BeforeBlock)
BUFFER(3, writeonly, uint, id, IdBlock)
BUFFER(4, readonly, vec4, saved, SavedBlock)
BUFFER(5, readonly, uint, savedId, SavedIdBlock)
BUFFER(6, readonly, uint, order, OrderBlock)

KERNEL(params.spheres) {
    uint from = order[invocation];
    position[invocation] = saved[from];
    velocity[invocation] = saved[params.spheres + from];
    if (HAS(BEFORE)) before[invocation] = saved[2u * params.spheres + from];
    id[invocation] = savedId[from];
}
