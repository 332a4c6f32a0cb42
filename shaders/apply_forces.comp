// Gives each sphere what the contacts of this substep have added up to.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(0, restrict, vec4, velocity, VelocityBlock)

#include "shared/kicks.h"

KERNEL(params.spheres) {
    uint at = kickOf(invocation);
    vec4 v = velocity[invocation];
    velocity[invocation] = vec4(vec3(v) + vec3(velocity[at]), v.w);
    velocity[at] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (HAS(FRICTION)) {
        at = at + params.spheres;
        vec4 spin = velocity[params.spheres + invocation];
        velocity[params.spheres + invocation] = vec4(vec3(spin) + vec3(velocity[at]), spin.w);
        velocity[at] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    }
}
