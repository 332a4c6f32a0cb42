// In an observed step: the velocities that the solver starts from, for statistics_impacts.comp.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(readonly, vec4, velocity)
BUFFER(writeonly, vec4, velocityBeforeSolve)

KERNEL(params.spheres) {
    velocityBeforeSolve[invocation] = velocity[invocation];
}
