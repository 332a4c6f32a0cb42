// Adds up anew what the contacts of each sphere with walls hold. held_by_pairs.comp adds the contacts between spheres.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, vec4, angularVelocity)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, vec4, wallImpulse)
BUFFER(readonly, vec4, wallTorque)
BUFFER(writeonly, vec4, unheldVelocity)
BUFFER(writeonly, vec4, unheldSpin)

KERNEL(params.spheres) {
    vec4 x = position[invocation];
    vec4 v = velocity[invocation];
    float inverseMass = inverseMassOf(v);
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
    unheldVelocity[invocation] = vec4(vec3(v) - impulse * inverseMass, parts);
    if (!HAS(FRICTION)) return;
    float lever = 2.5f * inverseMass / radiusOf(x);
    unheldSpin[invocation] = vec4(vec3(angularVelocity[invocation]) + torque * lever, 0.0f);
}
