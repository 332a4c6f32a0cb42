// Applies to each sphere the sums of the changes by the contacts of this substep.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(restrict, vec4, deltaVelocity)
BUFFER(restrict, vec4, deltaOmega)

KERNEL(params.spheres) {
    vec4 v = velocity[invocation];
    velocity[invocation] = vec4(vec3(v) + vec3(deltaVelocity[invocation]), v.w);
    deltaVelocity[invocation] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (HAS(FRICTION)) {
        vec4 omega = angularVelocity[invocation];
        angularVelocity[invocation] = vec4(vec3(omega) + vec3(deltaOmega[invocation]), omega.w);
        deltaOmega[invocation] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    }
}
