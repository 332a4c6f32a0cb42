// Lists the pairs of each group whose gap is below the margin. One walk fills a local array, which is then copied to a
// range of the pair array. A group with more pairs walks a second time. If a group finds no room, no group has a list
// (list_fit.comp), and the solvers then walk the cells themselves.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/outside.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, uint, cellStart)
BUFFER(coherent, uint, counters)
BUFFER(writeonly, uvec2, pairs)
BUFFER(writeonly, uvec4, groupRange)  // first pair, listed, touching, 1 if the group is active

#define LOCAL_PAIRS 192u
PRIVATE(uint, found)
PRIVATE(uint, base)      // index of the first pair; UNLISTED during the first walk
PRIVATE(uvec2, local[LOCAL_PAIRS])

void visitPair(uint a, uint b) {
    vec4 pa = position[a];
    vec4 pb = position[b];
    vec3 d = vec3(pa) - vec3(pb);
    float reach = radiusSum(pa, pb) + params.margin;
    if (!(dot3(d, d) < reach * reach) || lost(pa) || lost(pb)) return;
    if (base != UNLISTED) {
        pairs[base + found] = uvec2(a, b);
    } else if (found < LOCAL_PAIRS) {
        local[found] = uvec2(a, b);
    }
    found = found + 1u;
}

#include "shared/group.h"

KERNEL(params.groups * 8u) {
    found = 0u;
    base = UNLISTED;
    uint sampleRound = counters[COUNTER_REBUILDS];
    visitGroupNumber(invocation, sampleRound);
    uint count = found;
    if (sampled) {
        // Each new list takes another share of the pairs. The group therefore asks for a new list in each substep.
        atomicAdd(counters[COUNTER_SAMPLED], 1u);
        atomicOr(counters[COUNTER_REBUILD], 1u);
    }
    uint start = count == 0u ? 0u : atomicAdd(counters[COUNTER_PAIRS], count);
    if (count > params.pairCapacity || start > params.pairCapacity - count) {
        groupRange[invocation] = uvec4(0u, UNLISTED, 0u, 1u);
        return;
    }
    groupRange[invocation] = uvec4(start, count, 0u, 1u);
    if (count <= LOCAL_PAIRS) {
        // Alternates between the two halves, so that a solver need not wait for the result of the pair before.
        uint middle = (count + 1u) / 2u;
        for (uint k = 0u; k < middle; ++k) {
            pairs[start + 2u * k] = local[k];
            if (middle + k < count) pairs[start + 2u * k + 1u] = local[middle + k];
        }
    } else {
        found = 0u;
        base = start;
        visitGroupNumber(invocation, sampleRound);
    }
}
