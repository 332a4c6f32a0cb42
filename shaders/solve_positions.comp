// Pushes overlapping spheres apart, pair after pair (Gauss-Seidel), both sides at once, so that momentum is conserved;
// the push also becomes velocity, which is what carries the weight of a pile. `phase` is the level and the colour of the groups.
// Mueller et al. 2020, "Detailed Rigid Body Simulation with Extended Position Based Dynamics"; Macklin et al. 2019,
// "Small Steps in Physics Simulation": one iteration, small substeps.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/label.h"
#include "shared/contact.h"
#include "shared/wake.h"

BUFFER(0, restrict, vec4, position, PositionBlock)
BUFFER(1, restrict, vec4, velocity, VelocityBlock)
BUFFER(2, readonly, uint, label, LabelBlock)
BUFFER(3, readonly, uint, cellStart, CellBlock)
BUFFER(4, restrict, uvec4, span, SpanBlock)
BUFFER(5, restrict, uvec2, pairs, PairBlock)  // listed, then touching, then what presses those
BUFFER(6, readonly, vec4, before, BeforeBlock)
BUFFER(7, readonly, Law, laws, LawBlock)

#include "shared/laws.h"
#include "shared/sleepers.h"

PRIVATE(float, load)  // of the last pair: the impulse of its push, N s

// True when the pair overlaps.
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
    float inverse = 1.0f / (ma + mb);
    vec4 normal = normalAndDistance(d, squared, a, b);
    float depth = (reach - normal.w) * inverse;
    vec3 push = vec3(normal) * depth;
    vec3 kick = push * params.perSubstep;
    if (ma > 0.0f) {
        position[a] = vec4(vec3(pa) + push * ma, pa.w);
        velocity[a] = vec4(vec3(va) + kick * ma, va.w);
    }
    if (mb > 0.0f) {
        position[b] = vec4(vec3(pb) - push * mb, pb.w);
        velocity[b] = vec4(vec3(vb) - kick * mb, vb.w);
    }
    if (HAS(FRICTION)) {
        load = depth * params.perSubstep;
    }
    return true;
}

void visitPair(uint a, uint b) {
    separate(a, b);
}

#include "shared/group.h"

KERNEL(groupsOfPhase()) {
    uint group = groupOfPhase(invocation);
    uvec4 mine = span[group];
    if (HAS(SLEEP) && mine.w == 0u) return;
    if (mine.y == UNLISTED) {
        visitGroupNumber(group, mine.x);
        return;
    }
    uint touched = 0u;
    for (uint k = mine.x; k < mine.x + mine.y; ++k) {
        uvec2 pair = pairs[k];
        if (separate(pair.x, pair.y)) {
            uint to = params.pairCapacity + mine.x + touched;
            pairs[to] = pair;
            if (HAS(FRICTION)) pairs[params.pairCapacity + to] = uvec2(floatBitsToUint(load), 0u);
            touched = touched + 1u;
        }
    }
    span[group] = uvec4(mine.x, mine.y, touched, mine.w);
}
