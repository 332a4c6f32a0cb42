// Adds up anew what the contacts of each sphere with walls hold. held_by_pairs.comp adds the contacts between spheres.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, vec4, wallImpulse)
BUFFER(readonly, vec4, wallTorque)
BUFFER(writeonly, vec4, heldVelocity)
BUFFER(writeonly, vec4, heldSpin)

KERNEL(params.spheres) {
    vec4 x = position[invocation];
    float inverseMass = inverseMassOf(velocity[invocation]);
    uint first = idOf(idAndMaterial[invocation]) * params.maxWallHistory;
    vec3 impulse = vec3(0.0f, 0.0f, 0.0f);
    vec3 torque = vec3(0.0f, 0.0f, 0.0f);
    float parts = 0.0f;
    for (uint k = first; k < first + params.maxWallHistory; ++k) {
        if (!hasSlip(wallImpulse[k])) continue;
        parts = withPart(parts, surfaceOf(wallImpulse[k]));
        impulse = impulse + vec3(wallImpulse[k]);
        if (HAS(FRICTION)) torque = torque + vec3(wallTorque[k]);
    }
    heldVelocity[invocation] = vec4(impulse * inverseMass, parts);
    if (HAS(FRICTION)) heldSpin[invocation] = vec4(torque * (-2.5f * inverseMass / radiusOf(x)), 0.0f);
}
