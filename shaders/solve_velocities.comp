// Gives each touching pair its physical normal speed, pair after pair. Restitution works on bounce velocities that
// start from the velocities before the substep: an impact passes from pair to pair as in Newton's cradle. The position
// pass may have added separation speed. It is cut to the speed that the impact, or the pair's own separation,
// justifies. `phase` is the level and the colour of the groups.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/contact.h"

BUFFER(readonly, vec4, position)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, velocityBefore)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uint, cellStart)
BUFFER(readonly, uvec4, groupRange)
BUFFER(readonly, uvec2, touching)
BUFFER(restrict, float, normalImpulses)
BUFFER(readonly, ContactParams, contactParams)

#include "shared/contact_params.h"

// Returns the impulse along the normal (N s). It is negative if it reduces the push of the position pass.
float collide(uint a, uint b, bool touches) {
    vec4 pa = position[a];
    vec4 pb = position[b];
    vec3 d = vec3(pa) - vec3(pb);
    float squared = dot3(d, d);
    if (!touches) {
        float reach = radiusSum(pa, pb) * (1.0f + TOUCH_TOLERANCE);
        if (!(squared < reach * reach)) return 0.0f;
    }
    vec4 va = velocity[a];
    vec4 vb = velocity[b];
    float ma = effectiveInverseMass(va);
    float mb = effectiveInverseMass(vb);
    if (ma + mb == 0.0f) return 0.0f;
    float effectiveMass = 1.0f / (ma + mb);
    vec3 n = vec3(normalAndDistance(d, squared, a, b));
    vec4 ua = velocityBefore[a];
    vec4 ub = velocityBefore[b];
    vec4 contact = contactOf(a, b);
    float approach = dot3(vec3(ua) - vec3(ub), n);
    float e = HAS(RESTITUTION) ? restitutionOf(contact) : 0.0f;
    // Avoids a branch on the sign of `approach`, which is random between spheres at rest.
    float minSpeed = max(-e * approach, 0.0f);
    float maxSpeed = max(approach, minSpeed);
    vec3 rebound = n * ((maxSpeed - approach) * effectiveMass);
    velocityBefore[a] = withXyz(ua, vec3(ua) + rebound * ma);
    velocityBefore[b] = withXyz(ub, vec3(ub) - rebound * mb);
    float speed = dot3(vec3(va) - vec3(vb), n);
    float normalImpulse = (min(max(speed, minSpeed), maxSpeed) - speed) * effectiveMass;
    vec3 impulse = n * normalImpulse;
    if (ma > 0.0f) velocity[a] = withXyz(va, vec3(va) + impulse * ma);
    if (mb > 0.0f) velocity[b] = withXyz(vb, vec3(vb) - impulse * mb);
    return normalImpulse;
}

void visitPair(uint a, uint b) {
    collide(a, b, false);
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
    for (uint k = firstPair(range); k < firstPair(range) + touchingPairs(range); ++k) {
        uvec2 pair = touching[k];
        float impulse = collide(pair.x, pair.y, true);
        if (HAS(FRICTION)) normalImpulses[k] = normalImpulses[k] + impulse;
    }
}
