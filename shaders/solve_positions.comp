// Pushes overlapping spheres apart, pair after pair (Gauss-Seidel). Both sides move at once, so that momentum is
// conserved. The push also becomes velocity, which carries the weight of a pile. `phase` is the level and the colour of
// the groups.
//
// Mueller et al. 2020, "Detailed Rigid Body Simulation with Extended Position Based Dynamics"; Macklin et al. 2019,
// "Small Steps in Physics Simulation": one iteration, small substeps.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/contact.h"
#include "shared/wake.h"

BUFFER(restrict, vec4, position)
BUFFER(restrict, vec4, velocity)
BUFFER(readonly, uint, cellStart)
BUFFER(restrict, uvec4, groupRange)
BUFFER(readonly, uvec2, pairs)
BUFFER(writeonly, uvec2, touching)
BUFFER(writeonly, float, normalImpulses)  // of the touching pairs, N s
BUFFER(readonly, vec4, velocityBefore)

#include "shared/wake_pair.h"

// Overlaps deeper than this share of the radius were not caused by impacts or weight. Removing them stops spheres that
// approach, but adds no separation speed.
#define DEEP 0.25f

PRIVATE(float, load)  // impulse of the push of the last pair (N s)

// Returns true if the pair overlaps and at least one of its spheres can move.
bool separate(uint a, uint b) {
    vec4 va = velocity[a];
    vec4 vb = velocity[b];
    if (HAS(SLEEP) && va.w < 0.0f && vb.w < 0.0f) return false;
    vec4 pa = position[a];
    vec4 pb = position[b];
    vec3 d = vec3(pa) - vec3(pb);
    float squared = dot3(d, d);
    float reach = HAS(RADII) ? pa.w + pb.w : 2.0f * params.radius;
    if (HAS(SLEEP)) {
        float far = reach + wakeGap();
        if (!(squared < far * far)) return false;
        wake(a, b, va, vb);
    }
    if (!(squared < reach * reach)) return false;
    if (HAS(SLEEP)) {
        va = velocity[a];
        vb = velocity[b];
    }
    float ma = mobility(va.w);
    float mb = mobility(vb.w);
    if (ma + mb == 0.0f) return false;
    // A sleeper stays, but the other sphere does not get its share of the push. Otherwise, if both have borne an
    // overlap under load, the sphere that falls asleep last would be thrown out by all of it.
    float inverse = 1.0f / (abs(va.w) + abs(vb.w));
    vec4 normal = normalAndDistance(d, squared, a, b);
    vec3 n = vec3(normal);
    float depth = reach - normal.w;
    vec3 push = n * (depth * inverse);
    load = depth * params.perSubstep;
    if (depth > DEEP * (HAS(RADII) ? min(pa.w, pb.w) : params.radius))
        load = min(load, max(-dot3(vec3(va) - vec3(vb), n), 0.0f));
    load = load * inverse;
    vec3 kick = n * load;
    if (ma > 0.0f) {
        position[a] = vec4(vec3(pa) + push * ma, pa.w);
        velocity[a] = vec4(vec3(va) + kick * ma, va.w);
    }
    if (mb > 0.0f) {
        position[b] = vec4(vec3(pb) - push * mb, pb.w);
        velocity[b] = vec4(vec3(vb) - kick * mb, vb.w);
    }
    return true;
}

void visitPair(uint a, uint b) {
    separate(a, b);
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
    uint touched = 0u;
    for (uint k = mine.x; k < mine.x + mine.y; ++k) {
        uvec2 pair = pairs[k];
        if (separate(pair.x, pair.y)) {
            touching[mine.x + touched] = pair;
            if (HAS(FRICTION)) normalImpulses[mine.x + touched] = load;
            touched = touched + 1u;
        }
    }
    groupRange[group] = uvec4(mine.x, mine.y, touched, mine.w);
}
