// Pushes overlapping spheres apart, pair after pair (Gauss-Seidel). Both sides move at once, so that momentum is
// conserved. The push also becomes velocity, which carries the weight of a pile. `phase` is the level and the colour of
// the groups.
//
// Mueller et al. 2020, "Detailed Rigid Body Simulation with Extended Position Based Dynamics"; Macklin et al. 2019,
// "Small Steps in Physics Simulation": one iteration, small substeps.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
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

PRIVATE(float, normalImpulse)  // impulse of the push of the last pair (N s)

// Returns true if the pair overlaps and at least one of its spheres can move.
bool separate(uint a, uint b) {
    vec4 va = velocity[a];
    vec4 vb = velocity[b];
    if (HAS(SLEEP) && isAsleep(va) && isAsleep(vb)) return false;
    vec4 pa = position[a];
    vec4 pb = position[b];
    vec3 d = vec3(pa) - vec3(pb);
    float squared = dot3(d, d);
    float reach = radiusSum(pa, pb);
    if (HAS(SLEEP)) {
        float wakeReach = reach + wakeGap();
        if (!(squared < wakeReach * wakeReach)) return false;
        wake(a, b, va, vb);
    }
    if (!(squared < reach * reach)) return false;
    if (HAS(SLEEP)) {
        va = velocity[a];
        vb = velocity[b];
    }
    float ma = effectiveInverseMass(va);
    float mb = effectiveInverseMass(vb);
    if (ma + mb == 0.0f) return false;
    // A sleeper stays, but the other sphere does not get its share of the push. Otherwise, if both have borne an
    // overlap under load, the sphere that falls asleep last would be thrown out by all of it.
    float effectiveMass = 1.0f / (inverseMassOf(va) + inverseMassOf(vb));
    vec4 normal = normalAndDistance(d, squared, a, b);
    vec3 n = vec3(normal);
    float depth = reach - distanceOf(normal);
    vec3 push = n * (depth * effectiveMass);
    normalImpulse = depth * params.perSubstep;
    if (depth > DEEP * smallerRadius(pa, pb))
        normalImpulse = min(normalImpulse, max(-dot3(vec3(va) - vec3(vb), n), 0.0f));
    normalImpulse = normalImpulse * effectiveMass;
    vec3 impulse = n * normalImpulse;
    if (ma > 0.0f) {
        position[a] = withXyz(pa, vec3(pa) + push * ma);
        velocity[a] = withXyz(va, vec3(va) + impulse * ma);
    }
    if (mb > 0.0f) {
        position[b] = withXyz(pb, vec3(pb) - push * mb);
        velocity[b] = withXyz(vb, vec3(vb) - impulse * mb);
    }
    return true;
}

void visitPair(uint a, uint b) {
    separate(a, b);
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
    uint touched = 0u;
    for (uint k = firstPair(range); k < firstPair(range) + listedPairs(range); ++k) {
        uvec2 pair = pairs[k];
        if (separate(pair.x, pair.y)) {
            touching[firstPair(range) + touched] = pair;
            if (HAS(FRICTION)) normalImpulses[firstPair(range) + touched] = normalImpulse;
            touched = touched + 1u;
        }
    }
    groupRange[group] = withTouching(range, touched);
}
