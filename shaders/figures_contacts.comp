// Second pass of the figures of each sphere: counts the spheres that it touches, and finds the largest overlap with one.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/grid.h"
#include "shared/bundles.h"
#include "shared/contact.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, uint, cellStart)
BUFFER(readonly, uint, bundles)
BUFFER(readonly, uvec2, pairs)
BUFFER(coherent, uint, touching)  // spheres, walls and obstacles that each sphere touches
BUFFER(coherent, uint, deepest)   // bits of the largest overlap / r of each sphere, at least 0
BUFFER(readonly, uint, counters)
BUFFER(readonly, uint, cellOrder)
BUFFER(readonly, uint, isMover)

void visitPair(uint a, uint b) {
    vec4 pa = position[a];
    vec4 pb = position[b];
    vec3 d = separation(vec3(pa), vec3(pb));
    float reach = radiusSum(pa, pb);
    float touch = reach * (1.0f + TOUCH_TOLERANCE);
    float squared = dot3(d, d);
    if (!(squared < touch * touch)) return;
    if (HAS(FIXED) && isFixed(velocity[a]) && isFixed(velocity[b])) return;
    atomicAdd(touching[a], 1u);
    atomicAdd(touching[b], 1u);
    if (!(squared < reach * reach)) return;
    // A rounded root may exceed `reach`, and the bits of a negative number are large.
    uint overlap = floatBitsToUint(max(reach - sqrt(squared), 0.0f) / smallerRadius(pa, pb));
    atomicMax(deepest[a], overlap);
    atomicMax(deepest[b], overlap);
}

#include "shared/bundle_words.h"
#include "shared/visit_range.h"
#include "shared/group.h"

BUNDLE_KERNEL(params.bundles) {
    if (!hasList(invocation)) {
        if (FIRST_THREAD) visitBundle(invocation, firstPair(invocation));
    } else if (listedPairs(invocation) > 0u) {
        for (uint k = firstPair(invocation) + THREAD; k < endOfPairs(invocation); k += THREADS)
            visitPair(pairs[k].x, SECOND_OF(pairs[k]));
    }
}
