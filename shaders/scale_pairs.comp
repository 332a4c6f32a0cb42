// Scales what the contacts between spheres hold to a new length of the substep: a contact bears the same force.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(restrict, float, contactX)
BUFFER(restrict, float, contactY)
BUFFER(restrict, float, contactZ)
BUFFER(restrict, float, torqueX)
BUFFER(restrict, float, torqueY)
BUFFER(restrict, float, torqueZ)

KERNEL(2u * params.pairCapacity) {
    contactX[invocation] = contactX[invocation] * params.substepRatio;
    contactY[invocation] = contactY[invocation] * params.substepRatio;
    contactZ[invocation] = contactZ[invocation] * params.substepRatio;
    if (!HAS(FRICTION)) return;
    torqueX[invocation] = torqueX[invocation] * params.substepRatio;
    torqueY[invocation] = torqueY[invocation] * params.substepRatio;
    torqueZ[invocation] = torqueZ[invocation] * params.substepRatio;
}
