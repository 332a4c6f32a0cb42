// Gives each touching pair its physical normal speed, pair after pair. Restitution works on running velocities that
// start from the velocities before the substep: an impact passes from pair to pair as in Newton's cradle. The position
// pass may have added separation speed. It is cut to the speed that the impact, or the pair's own separation,
// justifies. `phase` is the level and the colour of the groups.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/id_and_material.h"
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
float collide(uint a, uint b, bool known) {
    vec4 pa = position[a];
    vec4 pb = position[b];
    vec3 d = vec3(pa) - vec3(pb);
    float squared = dot3(d, d);
    if (!known) {
        float reach = (HAS(RADII) ? pa.w + pb.w : 2.0f * params.radius) * (1.0f + TOUCH_TOLERANCE);
        if (!(squared < reach * reach)) return 0.0f;
    }
    vec4 va = velocity[a];
    vec4 vb = velocity[b];
    float ma = mobility(va.w);
    float mb = mobility(vb.w);
    if (ma + mb == 0.0f) return 0.0f;
    float inverse = 1.0f / (ma + mb);
    vec3 n = vec3(normalAndDistance(d, squared, a, b));
    vec4 ua = velocityBefore[a];
    vec4 ub = velocityBefore[b];
    vec4 law = contactOf(a, b);
    float approach = dot3(vec3(ua) - vec3(ub), n);
    float e = HAS(RESTITUTION) ? law.x : 0.0f;
    // Avoids a branch on the sign of `approach`, which is random between spheres at rest.
    float least = max(-e * approach, 0.0f);
    float most = max(approach, least);
    vec3 rebound = n * ((most - approach) * inverse);
    velocityBefore[a] = vec4(vec3(ua) + rebound * ma, ua.w);
    velocityBefore[b] = vec4(vec3(ub) - rebound * mb, ub.w);
    float speed = dot3(vec3(va) - vec3(vb), n);
    float strength = (min(max(speed, least), most) - speed) * inverse;
    vec3 impulse = n * strength;
    if (ma > 0.0f) velocity[a] = vec4(vec3(va) + impulse * ma, va.w);
    if (mb > 0.0f) velocity[b] = vec4(vec3(vb) - impulse * mb, vb.w);
    return strength;
}

void visitPair(uint a, uint b) {
    collide(a, b, false);
}

#include "shared/group.h"

KERNEL(groupsOfPhase()) {
    uint group = groupOfPhase(invocation);
    uvec4 mine = groupRange[group];
    if (HAS(SLEEP) && mine.w == 0u) return;
    if (mine.y == UNLISTED) {
        visitGroupNumber(group, mine.x);
        return;
    }
    for (uint k = mine.x; k < mine.x + mine.z; ++k) {
        uvec2 pair = touching[k];
        float impulse = collide(pair.x, pair.y, true);
        if (HAS(FRICTION)) normalImpulses[k] = normalImpulses[k] + impulse;
    }
}
