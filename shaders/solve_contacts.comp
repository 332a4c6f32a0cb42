// The model `balanced`: solves the listed contacts (shared/contact_law.h). `phase` is the level and the colour of the
// bundles.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/grid.h"
#include "shared/bundles.h"

BUFFER(coherent, vec4, position)
BUFFER(coherent, vec4, velocity)
BUFFER(coherent, vec4, angularVelocity)
BUFFER(coherent, vec4, velocityBefore)
BUFFER(coherent, vec4, unheldVelocity)
BUFFER(coherent, vec4, unheldSpin)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(coherent, uvec2, pairs)
BUFFER(restrict, uint, bundles)
BUFFER(restrict, float, contactX)
BUFFER(restrict, float, contactY)
BUFFER(restrict, float, contactZ)
BUFFER(restrict, float, torqueX)
BUFFER(restrict, float, torqueY)
BUFFER(restrict, float, torqueZ)

PRIVATE(uint, remembered)  // the first element of the contact memory of the present lists
PRIVATE(uintRow, memory)   // of the contacts that are solved
PRIVATE(mask, flagged)     // whether they hold an impulse from the substep before
PRIVATE(bool, someSleep)   // whether there may be sleepers

#include "shared/bundle_words.h"
#include "shared/contact.h"
#include "shared/friction.h"
#include "shared/contact_law.h"
#include "shared/wake.h"
#include "shared/contact_sums.h"

void readHeldTorque() {
    real3 torque = real3(ROW(torqueX, memory), ROW(torqueY, memory), ROW(torqueZ, memory));
    heldTorque = select(flagged, torque, real3(0.0f, 0.0f, 0.0f));
}

#include "shared/contact_pair.h"

bool beginBundle(uint bundle) {
    if (!hasList(bundle) || listedPairs(bundle) == 0u || (HAS(SLEEP) && !isActive(bundle))) return false;
    remembered = firstRemembered();
    someSleep = HAS(SLEEP) && mayHaveSleepers(bundle);
    contactReach = 2.0f * fastestSpeed(bundle) * params.substep + SLOP * params.radius;
    if (HAS(CONTACT_SUMS)) beginContactSums();
    return true;
}

void endBundle(uint bundle) {
    if (HAS(CONTACT_SUMS)) endContactSums(bundle);
}

// From this number on, the spheres exceed the caches of most processors. Below, prefetches cost more than they save.
#define MANY_SPHERES 100000u

bool expectsPairs() {
    return params.spheres >= MANY_SPHERES;
}

RARE void expectPairs(uint first, uint count) {
    for (uint k = first; k < first + count; ++k) {
        uint a = pairs[k].x;
        uint b = SECOND_OF(pairs[k]);
        PREFETCH(position[a])
        PREFETCH(position[b])
        PREFETCH(velocity[a])
        PREFETCH(velocity[b])
        if (!HAS(FRICTION)) continue;
        PREFETCH(angularVelocity[a])
        PREFETCH(angularVelocity[b])
    }
}

void toggleMemory(uint k) {
    pairs[k].y = pairs[k].y ^ PAIR_REMEMBERS;
}

void visitPairs(slots a, slots b, uintRow at) {
    if (HAS(SLEEP) && someSleep) {
        // Nothing moves a pair of sleepers.
        mask moves = MEMBER(velocity, a, w) > 0.0f || MEMBER(velocity, SLOTS_OF(b), w) > 0.0f;
        if (!anyLane(liveLanes() && moves)) return;
    }
    memory = at + remembered;
    flagged = REMEMBERS(pairs, b, at);
    real3 nothing = real3(0.0f, 0.0f, 0.0f);
    heldImpulse = nothing;
    if (anyLane(flagged)) {
        real3 impulse = real3(ROW(contactX, memory), ROW(contactY, memory), ROW(contactZ, memory));
        heldImpulse = select(flagged, impulse, nothing);
    }
    mask changed = solvePairs(liveLanes(), a, SLOTS_OF(b), true);
    if (!anyLane(changed)) return;
    SET_ALL(contactX, memory, heldImpulse.x)
    SET_ALL(contactY, memory, heldImpulse.y)
    SET_ALL(contactZ, memory, heldImpulse.z)
    if (HAS(FRICTION)) {
        SET_ALL(torqueX, memory, heldTorque.x)
        SET_ALL(torqueY, memory, heldTorque.y)
        SET_ALL(torqueZ, memory, heldTorque.z)
    }
    mask holds = heldImpulse.x != 0.0f || heldImpulse.y != 0.0f || heldImpulse.z != 0.0f;
    EACH_LANE(changed && ((holds && !flagged) || (flagged && !holds)), toggleMemory, at)
}

LANE_PAIR_KERNEL
