// In scenes with contact sums, before the contacts of a substep are solved: copies the states of the spheres for
// contact_sums_end.comp.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, vec4, angularVelocity)
BUFFER(writeonly, vec4, startPosition)
BUFFER(writeonly, vec4, startVelocity)
BUFFER(writeonly, vec4, startSpin)

KERNEL(params.spheres) {
    startVelocity[invocation] = velocity[invocation];
    if (HAS(FRICTION)) startSpin[invocation] = angularVelocity[invocation];
    if (HAS(FAST) || HAS(FIELDS)) startPosition[invocation] = position[invocation];
}
