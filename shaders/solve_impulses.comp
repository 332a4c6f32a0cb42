// The model `fast`: one sweep over the listed pairs (Gauss-Seidel). A pair that approaches gets the impulse of
// restitution and friction at its moment of impact, and flies on from there. An overlap that is left is removed by
// moving positions alone, so that it never becomes speed. Both conserve momentum, and no impulse adds energy. `phase`
// is the level and the colour of the bundles.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/fields.h"
#include "shared/grid.h"
#include "shared/bundles.h"
#include "shared/contact.h"
#include "shared/friction.h"

BUFFER(coherent, vec4, position)
BUFFER(coherent, vec4, velocity)
BUFFER(coherent, vec4, angularVelocity)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uint, cellStart)
BUFFER(restrict, uint, bundles)
BUFFER(readonly, uvec2, pairs)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(readonly, uint, counters)
BUFFER(readonly, uint, cellOrder)
BUFFER(readonly, uint, isMover)

#include "shared/contact_params.h"
#include "shared/contact_sums.h"
#include "shared/friction_pair.h"
#include "shared/wake.h"

// An impact may be found late, because the sweep visits a pair once, perhaps before other impacts change its course.
// Courses are followed back for this number of substeps at most: farther back, other impacts have bent them.
#define LATEST_IMPACT 2.0f

// The time since two centres were as near as the sum of their radii (s). `along` is the product of their distance and
// relative velocity (m^2/s). `squared` is that velocity squared (m^2/s^2). `missing` is the squared sum of the radii
// without the squared distance (m^2, positive). Neither form subtracts nearly equal numbers.
float timeSinceTouch(float along, float squared, float missing) {
    float root = sqrt(along * along + squared * missing);
    return along < 0.0f ? missing / (root - along) : (along + root) / max(squared, 1.0e-30f);
}

void visitPair(uint a, uint b) {
    vec4 va = velocity[a];
    vec4 vb = velocity[b];
    if (HAS(SLEEP) && isAsleep(va) && isAsleep(vb)) return;
    vec4 pa = position[a];
    vec4 pb = position[b];
    vec3 d = separation(vec3(pa), vec3(pb));
    float squared = dot3(d, d);
    float reach = radiusSum(pa, pb);
    if (!(squared < reach * reach)) return;
    float ma = effectiveInverseMass(va);
    float mb = effectiveInverseMass(vb);
    if (ma + mb == 0.0f) return;
    float effectiveMass = 1.0f / (ma + mb);
    vec3 n = vec3(normalAndDistance(d, squared, a, b));
    vec3 difference = vec3(va) - vec3(vb);
    float speed = dot3(difference, n);
    // Slower approaches come from the weight of a pile, which one sweep does not balance. They do not bounce.
    float slowest = params.deadBand;
    if (HAS(FIELDS)) {
        vec3 own = accelerationAt(vec3(pa), radiusOf(pa), inverseMassOf(va));
        slowest = max(slowest, 2.0f * sqrt(dot3(own, own)) * params.substep);
    }
    // Spheres that touched in this substep may part already: they have met at the edge.
    float since = timeSinceTouch(dot3(d, difference), dot3(difference, difference), reach * reach - squared);
    bool impact = false;
    if (speed < -slowest || since <= params.substep) {
        since = min(since, LATEST_IMPACT * params.substep);
        vec3 met = d - difference * since;
        vec3 normal = vec3(normalAndDistance(met, dot3(met, met), a, b));
        float approach = dot3(difference, normal);
        impact = approach < -slowest;
        if (impact) {
            n = normal;
            speed = approach;
        }
    }
    if (HAS(SLEEP) && (isAsleep(va) || isAsleep(vb)) && impact && speed < -params.wakeSpeed &&
        speed > -params.perSubstep * smallerRadius(pa, pb) * MOST_WAIT)
        return;
    vec3 xa = vec3(pa);
    vec3 xb = vec3(pb);
    if (speed < 0.0f) {
        vec4 contact = contactOf(a, b);
        float e = HAS(RESTITUTION) && impact ? restitutionOf(contact) : 0.0f;
        float normalImpulse = -(1.0f + e) * speed * effectiveMass;
        vec3 impulse = n * normalImpulse;
        if (ma > 0.0f) velocity[a] = withXyz(va, vec3(va) + impulse * ma);
        if (mb > 0.0f) velocity[b] = withXyz(vb, vec3(vb) - impulse * mb);
        if (HAS(FRICTION))
            applyPairFriction(a, b, n, radiusOf(pa), radiusOf(pb), normalImpulse, contact);
        if (HAS(CONTACT_SUMS)) {
            vec3 total = ma > 0.0f ? (vec3(velocity[a]) - vec3(va)) * (1.0f / ma)
                                   : (vec3(vb) - vec3(velocity[b])) * (1.0f / mb);
            addToContactSums(true, n * (impact ? reach : sqrt(squared)), total, impact);
        }
        if (impact) {
            // Both fly on from the point of impact at their new velocities. This keeps angular momentum.
            xa = xa + (vec3(velocity[a]) - vec3(va)) * since;
            xb = xb + (vec3(velocity[b]) - vec3(vb)) * since;
            d = separation(xa, xb);
            squared = dot3(d, d);
        }
    }
    if (squared < reach * reach) {
        vec4 normal = normalAndDistance(d, squared, a, b);
        vec3 push = vec3(normal) * ((reach - distanceOf(normal)) * effectiveMass);
        xa = xa + push * ma;
        xb = xb - push * mb;
    }
    if (ma > 0.0f) position[a] = withXyz(pa, xa);
    if (mb > 0.0f) position[b] = withXyz(pb, xb);
}

#include "shared/bundle_words.h"
#include "shared/visit_range.h"
#include "shared/group.h"

void endBundle(uint bundle) {
    if (HAS(CONTACT_SUMS)) endContactSums(bundle);
}

bool beginBundle(uint bundle) {
    if (HAS(SLEEP) && !isActive(bundle)) return false;
    if (HAS(CONTACT_SUMS)) beginContactSums();
    if (hasList(bundle)) return listedPairs(bundle) > 0u;
    if (FIRST_THREAD) visitBundle(bundle, firstPair(bundle));
    endBundle(bundle);
    return false;
}

void visitPairs(uint a, uint b, uint at) {
    visitPair(a, b);
}

PAIR_KERNEL
