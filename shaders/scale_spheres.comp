// Scales what the contacts of each sphere hold to a new length of the substep. scale_pairs.comp scales the contacts
// between spheres, this kernel those with walls.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(readonly, vec4, velocity)
BUFFER(readonly, vec4, angularVelocity)
BUFFER(restrict, vec4, unheldVelocity)
BUFFER(restrict, vec4, unheldSpin)
BUFFER(restrict, uint, accelerationXz)
BUFFER(restrict, uint, accelerationYz)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(restrict, vec4, wallImpulse)
BUFFER(restrict, vec4, wallTorque)

vec4 scaled(vec4 row) {
    return withXyz(row, vec3(row) * params.substepRatio);
}

// `whole`: a velocity or a spin. `unheld`: the same without held impulses.
vec4 withHeldScaled(vec4 whole, vec4 unheld) {
    return withXyz(unheld, vec3(whole) - (vec3(whole) - vec3(unheld)) * params.substepRatio);
}

KERNEL(params.spheres) {
    unheldVelocity[invocation] = withHeldScaled(velocity[invocation], unheldVelocity[invocation]);
    vec3 own = ownAcceleration(accelerationXz[invocation], accelerationYz[invocation]) * params.substepRatio;
    accelerationXz[invocation] = accelerationXzOf(own);
    accelerationYz[invocation] = accelerationYzOf(own);
    if (HAS(FRICTION)) unheldSpin[invocation] = withHeldScaled(angularVelocity[invocation], unheldSpin[invocation]);
    uint first = idOf(idAndMaterial[invocation]) * params.maxWallHistory;
    for (uint k = first; k < first + params.maxWallHistory; ++k) {
        wallImpulse[k] = scaled(wallImpulse[k]);
        if (HAS(FRICTION)) wallTorque[k] = scaled(wallTorque[k]);
    }
}
