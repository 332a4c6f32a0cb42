// In an observed step: the velocities that the solver starts from, for statistics_impacts.comp. They lie where the state is
// saved while it is put in cell order: nobody reads that between two rebuilds.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(0, readonly, vec4, velocity, VelocityBlock)
BUFFER(1, writeonly, vec4, saved, SavedBlock)

KERNEL(params.spheres) {
    saved[invocation] = velocity[invocation];
}
