// In an observed step: copies the velocities from which the solver starts, for statistics_impacts.comp.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(readonly, vec4, velocity)
BUFFER(writeonly, vec4, velocityBeforeSolve)

KERNEL(params.spheres) {
    velocityBeforeSolve[invocation] = velocity[invocation];
}
