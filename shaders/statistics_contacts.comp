// Adds up the overlaps of the pairs of each bundle. The host adds up the bundles. Counts them for each sphere, after
// statistics_spheres.comp has counted the walls.
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
BUFFER(coherent, uint, touching)   // spheres, walls and obstacles that each sphere touches
BUFFER(writeonly, vec4, overlaps)  // contacts, sum and largest of overlap / r, energy in springs (J)
BUFFER(readonly, uint, counters)
BUFFER(readonly, uint, cellOrder)
BUFFER(readonly, uint, isMover)

PRIVATE(float, contacts)
PRIVATE(float, sum)
PRIVATE(float, largest)
SHARED(vec3, partialSums[BUNDLE_THREADS])

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
    float overlap = max(reach - sqrt(squared), 0.0f) / smallerRadius(pa, pb);
    contacts = contacts + 1.0f;
    sum = sum + overlap;
    largest = max(largest, overlap);
}

#include "shared/bundle_words.h"
#include "shared/visit_range.h"
#include "shared/group.h"

void beginSum() {
    contacts = 0.0f;
    sum = 0.0f;
    largest = 0.0f;
}

BUNDLE_KERNEL(params.bundles) {
    if (!hasList(invocation)) {
        if (!FIRST_THREAD) return;
        beginSum();
        visitBundle(invocation, firstPair(invocation));
        overlaps[invocation] = vec4(contacts, sum, largest, 0.0f);
        return;
    }
    if (listedPairs(invocation) == 0u) {
        if (FIRST_THREAD) overlaps[invocation] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
        return;
    }
    // The sums have one order for any number of threads.
    for (uint part = THREAD; part < BUNDLE_THREADS; part += THREADS) {
        beginSum();
        for (uint k = firstPair(invocation) + part; k < endOfPairs(invocation); k += BUNDLE_THREADS)
            visitPair(pairs[k].x, SECOND_OF(pairs[k]));
        partialSums[part] = vec3(contacts, sum, largest);
    }
    BARRIER
    if (!FIRST_THREAD) return;
    beginSum();
    for (uint part = 0u; part < BUNDLE_THREADS; ++part) {
        contacts = contacts + partialSums[part].x;
        sum = sum + partialSums[part].y;
        largest = max(largest, partialSums[part].z);
    }
    overlaps[invocation] = vec4(contacts, sum, largest, 0.0f);
}
