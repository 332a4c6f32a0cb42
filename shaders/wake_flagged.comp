// Wakes the sleepers that wake.comp has flagged.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(restrict, vec4, velocity)
BUFFER(restrict, uint, wakeFlags)

KERNEL(params.spheres) {
    if (wakeFlags[invocation] == 0u) return;
    wakeFlags[invocation] = 0u;
    vec4 v = velocity[invocation];
    velocity[invocation] = vec4(vec3(v), inverseMassOf(v));
}
