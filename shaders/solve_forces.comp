// The model `accurate`: adds up the forces between overlapping soft spheres on both sides, while velocities stay
// unchanged. (If velocities changed at once, each pair would see the incomplete sum of the other forces, take it for
// slip, and load its spring.) The displacement of the tangential spring is stored with the listed pair. `phase` is the
// level and the colour of the bundles.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/grid.h"
#include "shared/bundles.h"
#include "shared/contact.h"
#include "shared/friction.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, positionLow)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, vec4, angularVelocity)
BUFFER(coherent, vec4, deltaVelocity)
BUFFER(coherent, vec4, deltaOmega)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uint, cellStart)
BUFFER(restrict, uint, bundles)
BUFFER(coherent, uvec2, pairs)
BUFFER(restrict, float, contactX)
BUFFER(restrict, float, contactY)
BUFFER(restrict, float, contactZ)
BUFFER(readonly, uint, counters)
BUFFER(readonly, ContactParams, contactParams)

PRIVATE(vec3, displacement)
PRIVATE(bool, touches)
PRIVATE(bool, listed)     // the pair keeps its displacement; an unlisted pair begins anew in each substep

#include "shared/contact_params.h"
#include "shared/contact_sums.h"
#include "shared/deltas.h"
#include "shared/spring.h"

// `lever` is the distance over the sum of the radii. The centres share the distance to the point of contact in
// proportion to the radii.
void applySpringFriction(uint a, uint b, vec3 n, float ra, float rb, float lever, Spring spring, vec4 contact) {
    vec4 va = velocity[a];
    vec4 vb = velocity[b];
    vec4 sa = angularVelocity[a];
    vec4 sb = angularVelocity[b];
    vec3 difference = vec3(va) - vec3(vb);
    vec3 slip = difference - n * dot3(difference, n) - cross3(vec3(sa) * ra + vec3(sb) * rb, n) * lever;
    displacement = rotateToPlane(displacement, n);
    float slipPerImpulse = (awakeInverseMass(va) + awakeInverseMass(vb)) * (1.0f + 2.5f * lever * lever);
    vec3 impulse = tangentialImpulse(slip, slip, slipPerImpulse, spring, frictionOf(contact));
    if (HAS(CONTACT_SUMS)) addToContactSums(true, n * (lever * (ra + rb)), impulse, false);
    vec3 slipMoment = cross3(n, impulse) * (2.5f * lever);
    vec3 moment = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(ROLLING)) {
        float c = 2.5f * (awakeInverseMass(va) / (ra * ra) + awakeInverseMass(vb) / (rb * rb));
        float maxMoment = ra * rb / (ra + rb) * spring.impulse;
        vec3 omega = vec3(sa) - vec3(sb);
        float about = dot3(omega, n);
        moment = (rollingMoment(omega - n * about, c, rollingResistanceOf(contact) * maxMoment) +
                  spinningMoment(n, about, c, spinningResistanceOf(contact) * maxMoment)) * 2.5f;
    }
    // Compilers may factor these differently on each device.
    precise vec3 deltaOmegaA = moment * (awakeInverseMass(va) / (ra * ra)) - slipMoment * (awakeInverseMass(va) / ra);
    precise vec3 deltaOmegaB = moment * (-awakeInverseMass(vb) / (rb * rb)) - slipMoment * (awakeInverseMass(vb) / rb);
    addDeltaVelocity(a, impulse * awakeInverseMass(va));
    addDeltaVelocity(b, impulse * -awakeInverseMass(vb));
    addDeltaOmega(a, deltaOmegaA);
    addDeltaOmega(b, deltaOmegaB);
}

void visitPair(uint a, uint b) {
    vec4 pa = position[a];
    vec4 pb = position[b];
    vec3 d = separation(vec3(pa), vec3(pb));
    d = d + (vec3(positionLow[a]) - vec3(positionLow[b]));
    float squared = dot3(d, d);
    float ra = radiusOf(pa);
    float rb = radiusOf(pb);
    float reach = ra + rb;
    touches = squared < reach * reach;
    if (!touches) return;
    if (!listed) displacement = vec3(0.0f, 0.0f, 0.0f);
    vec4 va = velocity[a];
    vec4 vb = velocity[b];
    float inverseMassSum = awakeInverseMass(va) + awakeInverseMass(vb);
    touches = !HAS(FIXED) || inverseMassSum > 0.0f;
    if (!touches) return;
    vec4 normal = normalAndDistance(d, squared, a, b);
    vec3 n = vec3(normal);
    float speed = dot3(vec3(va) - vec3(vb), n);
    float overlap = max(reach - distanceOf(normal), 0.0f);  // a rounded root may exceed `reach`
    Spring spring = springOf(overlap, speed, speed, ra * rb / reach, inverseMassSum, stiffnessOf(a, b));
    vec3 impulse = n * spring.impulse;
    // A collision is counted when the spheres begin to touch.
    if (HAS(CONTACT_SUMS)) addToContactSums(true, n * distanceOf(normal), impulse, spring.share < 1.0f);
    addDeltaVelocity(a, impulse * awakeInverseMass(va));
    addDeltaVelocity(b, impulse * -awakeInverseMass(vb));
    if (HAS(FRICTION)) applySpringFriction(a, b, n, ra, rb, distanceOf(normal) / reach, spring, contactOf(a, b));
}

#include "shared/bundle_words.h"
#include "shared/contact_memory.h"
#define NO_MOVERS  // in `accurate`, no sphere sleeps
#include "shared/visit_range.h"
#include "shared/group.h"
#undef NO_MOVERS

void endBundle(uint bundle) {
    if (HAS(CONTACT_SUMS)) endContactSums(bundle);
}

bool beginBundle(uint bundle) {
    if (HAS(CONTACT_SUMS)) beginContactSums();
    listed = hasList(bundle);
    if (listed) return listedPairs(bundle) > 0u;
    if (FIRST_THREAD) visitBundle(bundle, firstPair(bundle));
    endBundle(bundle);
    return false;
}

void visitPairs(uint a, uint b, uint at) {
    if (!HAS(FRICTION)) {
        visitPair(a, SLOTS_OF(b));
        return;
    }
    uint memory = presentHalf() + at;
    bool remembers = REMEMBERS(pairs, b, at);
    displacement = vec3(0.0f, 0.0f, 0.0f);
    if (remembers) displacement = vec3(contactX[memory], contactY[memory], contactZ[memory]);
    visitPair(a, SLOTS_OF(b));
    if (!touches) displacement = vec3(0.0f, 0.0f, 0.0f);
    bool stays = displacement.x != 0.0f || displacement.y != 0.0f || displacement.z != 0.0f;
    if (stays != remembers) pairs[at].y = b ^ PAIR_REMEMBERS;
    if (!stays && !remembers) return;
    contactX[memory] = displacement.x;
    contactY[memory] = displacement.y;
    contactZ[memory] = displacement.z;
}

PAIR_KERNEL
