// The model `fast`: one sweep over the listed pairs (Gauss-Seidel). A pair that approaches gets the impulse of
// restitution and friction. An overlap is removed by moving positions alone, so that it never becomes speed. Both
// conserve momentum, and no impulse adds energy. `phase` is the level and the colour of the groups.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/id_and_material.h"
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
    if (HAS(SLEEP) && va.w < 0.0f && vb.w < 0.0f) return;
    vec4 pa = position[a];
    vec4 pb = position[b];
    vec3 d = vec3(pa) - vec3(pb);
    float squared = dot3(d, d);
    float reach = HAS(RADII) ? pa.w + pb.w : 2.0f * params.radius;
    if (HAS(SLEEP)) {
        float far = reach + wakeGap();
        if (!(squared < far * far)) return;
        wake(a, b, va, vb);
    }
    if (!(squared < reach * reach)) return;
    if (HAS(SLEEP)) {
        va = velocity[a];
        vb = velocity[b];
    }
    float ma = mobility(va.w);
    float mb = mobility(vb.w);
    if (ma + mb == 0.0f) return;
    float inverse = 1.0f / (ma + mb);
    vec4 normal = normalAndDistance(d, squared, a, b);
    vec3 n = vec3(normal);
    vec3 push = n * ((reach - normal.w) * inverse);
    if (ma > 0.0f) position[a] = vec4(vec3(pa) + push * ma, pa.w);
    if (mb > 0.0f) position[b] = vec4(vec3(pb) - push * mb, pb.w);
    float speed = dot3(vec3(va) - vec3(vb), n);
    if (speed >= 0.0f) return;
    vec4 law = contactOf(a, b);
    // Slower approaches come from the weight of a pile, which one sweep does not balance. They do not bounce.
    float e = HAS(RESTITUTION) && speed < -params.deadBand ? law.x : 0.0f;
    float load = -(1.0f + e) * speed * inverse;
    vec3 impulse = n * load;
    if (ma > 0.0f) velocity[a] = vec4(vec3(va) + impulse * ma, va.w);
    if (mb > 0.0f) velocity[b] = vec4(vec3(vb) - impulse * mb, vb.w);
    if (HAS(FRICTION))
        applyPairFriction(a, b, n, HAS(RADII) ? pa.w : params.radius, HAS(RADII) ? pb.w : params.radius, load, law);
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
    for (uint k = mine.x; k < mine.x + mine.y; ++k) visitPair(pairs[k].x, pairs[k].y);
}
