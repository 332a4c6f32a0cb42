// The model `fast`: one sweep over the listed pairs (Gauss-Seidel). A pair that approaches gets the impulse of
// restitution and friction. An overlap is removed by moving positions alone, so that it never becomes speed. Both
// conserve momentum, and no impulse adds energy. `phase` is the level and the colour of the groups.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/contact.h"
#include "shared/wake.h"
#include "shared/friction.h"

BUFFER(restrict, vec4, position)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uint, cellStart)
BUFFER(readonly, uvec4, groupRange)
BUFFER(readonly, uvec2, pairs)
BUFFER(readonly, vec4, velocityBefore)
BUFFER(readonly, ContactParams, contactParams)

#include "shared/contact_params.h"
#include "shared/friction_pair.h"
#include "shared/wake_pair.h"

void visitPair(uint a, uint b) {
    vec4 va = velocity[a];
    vec4 vb = velocity[b];
    if (HAS(SLEEP) && isAsleep(va) && isAsleep(vb)) return;
    vec4 pa = position[a];
    vec4 pb = position[b];
    vec3 d = vec3(pa) - vec3(pb);
    float squared = dot3(d, d);
    float reach = radiusSum(pa, pb);
    if (HAS(SLEEP)) {
        float wakeReach = reach + wakeGap();
        if (!(squared < wakeReach * wakeReach)) return;
        wake(a, b, va, vb);
    }
    if (!(squared < reach * reach)) return;
    if (HAS(SLEEP)) {
        va = velocity[a];
        vb = velocity[b];
    }
    float ma = effectiveInverseMass(va);
    float mb = effectiveInverseMass(vb);
    if (ma + mb == 0.0f) return;
    float effectiveMass = 1.0f / (ma + mb);
    vec4 normal = normalAndDistance(d, squared, a, b);
    vec3 n = vec3(normal);
    vec3 push = n * ((reach - distanceOf(normal)) * effectiveMass);
    if (ma > 0.0f) position[a] = withXyz(pa, vec3(pa) + push * ma);
    if (mb > 0.0f) position[b] = withXyz(pb, vec3(pb) - push * mb);
    float speed = dot3(vec3(va) - vec3(vb), n);
    if (speed >= 0.0f) return;
    vec4 contact = contactOf(a, b);
    // Slower approaches come from the weight of a pile, which one sweep does not balance. They do not bounce.
    float e = HAS(RESTITUTION) && speed < -params.deadBand ? restitutionOf(contact) : 0.0f;
    float normalImpulse = -(1.0f + e) * speed * effectiveMass;
    vec3 impulse = n * normalImpulse;
    if (ma > 0.0f) velocity[a] = withXyz(va, vec3(va) + impulse * ma);
    if (mb > 0.0f) velocity[b] = withXyz(vb, vec3(vb) - impulse * mb);
    if (HAS(FRICTION))
        applyPairFriction(a, b, n, radiusOf(pa), radiusOf(pb), normalImpulse, contact);
}

#include "shared/group.h"

KERNEL(groupsOfPhase()) {
    uint group = groupOfPhase(invocation);
    uvec4 range = groupRange[group];
    if (HAS(SLEEP) && !isActive(range)) return;
    if (!hasList(range)) {
        visitGroupNumber(group, unlistedRound(range));
        return;
    }
    for (uint k = firstPair(range); k < firstPair(range) + listedPairs(range); ++k) visitPair(pairs[k].x, pairs[k].y);
}
