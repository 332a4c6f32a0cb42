// In scenes with contact sums, in the model `balanced`: adds the impulses that sleepers hold at walls and obstacles. They
// keep the impulses with which they fell asleep, without the moments of rolling resistance.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, vec4, wallImpulse)
BUFFER(readonly, vec4, wallTorque)
BUFFER(coherent, uint, surfaceSums)

#include "shared/surface_sums.h"

KERNEL(params.spheres) {
    if (!isAsleep(velocity[invocation])) return;
    vec4 x = position[invocation];
    uint id = idOf(idAndMaterial[invocation]);
    for (uint k = id * params.maxWallHistory; k < (id + 1u) * params.maxWallHistory; ++k) {
        vec4 held = wallImpulse[k];
        if (!hasSlip(held)) continue;
        precise vec3 moment = cross3(vec3(x), vec3(held));
        if (HAS(FRICTION)) moment = moment - vec3(wallTorque[k]) * radiusOf(x);
        addToSurfaceSums(id, surfaceOf(held), vec3(held), moment);
    }
}
