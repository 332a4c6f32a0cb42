// Adds up the overlaps of the pairs of each group. The host adds up the groups.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/grid.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, uint, cellStart)
BUFFER(readonly, uvec4, groupRange)
BUFFER(readonly, uvec2, pairs)
BUFFER(writeonly, vec4, overlaps)  // contacts, sum and largest of overlap / r, energy in springs (J)

PRIVATE(float, contacts)
PRIVATE(float, sum)
PRIVATE(float, largest)

void visitPair(uint a, uint b) {
    vec4 pa = position[a];
    vec4 pb = position[b];
    vec3 d = vec3(pa) - vec3(pb);
    float reach = radiusSum(pa, pb);
    float squared = dot3(d, d);
    if (!(squared < reach * reach)) return;
    float overlap = (reach - sqrt(squared)) / smallerRadius(pa, pb);
    contacts = contacts + 1.0f;
    sum = sum + overlap;
    largest = max(largest, overlap);
}

#include "shared/group.h"

KERNEL(params.groups * 8u) {
    contacts = 0.0f;
    sum = 0.0f;
    largest = 0.0f;
    uvec4 range = groupRange[invocation];
    if (!hasList(range)) {
        visitGroupNumber(invocation, unlistedRound(range));
    } else {
        for (uint k = firstPair(range); k < firstPair(range) + listedPairs(range); ++k)
            visitPair(pairs[k].x, pairs[k].y);
    }
    overlaps[invocation] = vec4(contacts, sum, largest, 0.0f);
}
