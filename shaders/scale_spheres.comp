// Scales what the contacts of each sphere hold to a new length of the substep. scale_pairs.comp scales the contacts
// between spheres, this kernel those with walls.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(restrict, vec4, heldVelocity)
BUFFER(restrict, vec4, heldSpin)
BUFFER(restrict, vec4, acceleration)
BUFFER(restrict, vec4, wallImpulse)
BUFFER(restrict, vec4, wallTorque)

vec4 scaled(vec4 row) {
    return withXyz(row, vec3(row) * params.substepRatio);
}

KERNEL(params.spheres) {
    heldVelocity[invocation] = scaled(heldVelocity[invocation]);
    acceleration[invocation] = scaled(acceleration[invocation]);
    if (HAS(FRICTION)) heldSpin[invocation] = scaled(heldSpin[invocation]);
    for (uint k = invocation * params.maxWallHistory; k < (invocation + 1u) * params.maxWallHistory; ++k) {
        wallImpulse[k] = scaled(wallImpulse[k]);
        if (HAS(FRICTION)) wallTorque[k] = scaled(wallTorque[k]);
    }
}
