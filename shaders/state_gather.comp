// Writes the state in cell order.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(0, writeonly, vec4, position, PositionBlock)
BUFFER(1, writeonly, vec4, velocity, VelocityBlock)
BUFFER(2, writeonly, vec4, before, BeforeBlock)
BUFFER(3, writeonly, uint, label, LabelBlock)
BUFFER(4, readonly, vec4, saved, SavedBlock)
BUFFER(5, readonly, uint, savedLabel, SavedLabelBlock)
BUFFER(6, readonly, uint, order, OrderBlock)

KERNEL(params.spheres) {
    uint from = order[invocation];
    label[invocation] = savedLabel[from];
    position[invocation] = saved[from];
    from = from + params.spheres;
    velocity[invocation] = saved[from];
    if (HAS(BEFORE)) {
        from = from + params.spheres;
        before[invocation] = saved[from];
    }
    if (HAS(FRICTION)) {
        from = from + params.spheres;
        velocity[params.spheres + invocation] = saved[from];
    }
    if (HAS(RESIDUAL)) {
        from = from + params.spheres;
        position[params.spheres + invocation] = saved[from];
    }
}
