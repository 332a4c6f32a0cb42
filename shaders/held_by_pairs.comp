// Adds up anew what the contacts between spheres hold, after held_by_walls.comp. `phase` is the level and the colour of
// the bundles.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/grid.h"
#include "shared/bundles.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, uint, bundles)
BUFFER(readonly, uvec2, pairs)
BUFFER(readonly, float, contactX)
BUFFER(readonly, float, contactY)
BUFFER(readonly, float, contactZ)
BUFFER(readonly, float, torqueX)
BUFFER(readonly, float, torqueY)
BUFFER(readonly, float, torqueZ)
BUFFER(readonly, uint, counters)
BUFFER(coherent, vec4, unheldVelocity)
BUFFER(coherent, vec4, unheldSpin)

#include "shared/bundle_words.h"
#include "shared/contact_memory.h"

void addHeld(uint sphere, vec3 impulse, vec3 torque) {
    float inverseMass = inverseMassOf(velocity[sphere]);
    vec4 unheld = unheldVelocity[sphere];
    unheldVelocity[sphere] = vec4(vec3(unheld) - impulse * inverseMass, unheld.w + 1.0f);
    if (!HAS(FRICTION)) return;
    float lever = 2.5f * inverseMass / radiusOf(position[sphere]);
    unheldSpin[sphere] = vec4(vec3(unheldSpin[sphere]) + torque * lever, 0.0f);
}

bool beginBundle(uint bundle) {
    return hasList(bundle) && listedPairs(bundle) > 0u;
}

void endBundle(uint bundle) {
}

void visitPairs(uint a, uint b, uint at) {
    if (!REMEMBERS(pairs, b, at)) return;
    uint memory = presentHalf() + at;
    vec3 impulse = vec3(contactX[memory], contactY[memory], contactZ[memory]);
    if (impulse.x == 0.0f && impulse.y == 0.0f && impulse.z == 0.0f) return;  // scale_pairs.comp has made it so small
    vec3 torque = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(FRICTION)) torque = vec3(torqueX[memory], torqueY[memory], torqueZ[memory]);
    addHeld(a, impulse, torque);
    addHeld(SLOTS_OF(b), -impulse, torque);
}

PAIR_KERNEL
