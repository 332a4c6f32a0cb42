// Applies to each sphere the sums of the changes by the contacts of this substep.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(restrict, vec4, deltaVelocity)
BUFFER(restrict, vec4, deltaOmega)

KERNEL(params.spheres) {
    vec4 v = velocity[invocation];
    velocity[invocation] = withXyz(v, vec3(v) + vec3(deltaVelocity[invocation]));
    deltaVelocity[invocation] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (HAS(FRICTION)) {
        vec4 omega = angularVelocity[invocation];
        angularVelocity[invocation] = withXyz(omega, vec3(omega) + vec3(deltaOmega[invocation]));
        deltaOmega[invocation] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    }
}
