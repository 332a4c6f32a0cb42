// Finds the pairs of each group of 2 x 2 x 2 cells whose gap is below the margin: the candidates. One walk fills a
// local array, which is then copied. A group with more pairs walks a second time. Pairs of fixed spheres are left out.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/grid.h"
#include "shared/bundles.h"
#include "shared/limits.h"
#include "shared/outside.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, float, sortedX)
BUFFER(readonly, float, sortedY)
BUFFER(readonly, float, sortedZ)
BUFFER(readonly, float, sortedRadius)
BUFFER(readonly, uint, cellStart)
BUFFER(coherent, uint, counters)
BUFFER(writeonly, uvec2, candidates)  // slots; the high bit of the first is set if the pair is far
BUFFER(writeonly, uvec2, groupRange)  // first candidate, candidates

#define LOCAL_PAIRS 192u
// Pairs with a gap above this share of the smaller radius are far. They come last in their batch, so that pairs that
// touch are together in the lanes of the solver.
#define FAR_GAP 0.05f
PRIVATE(uint, found)
PRIVATE(uint, base)      // index of the first pair; UNLISTED during the first walk
PRIVATE(uvec2, local[LOCAL_PAIRS])

PRIVATE(uint, visited)   // the sphere whose range is visited

void addPair(uint b, bool isFar) {
    uvec2 pair = uvec2(isFar ? visited | 0x80000000u : visited, b);
    if (base != UNLISTED) {
        candidates[base + found] = pair;
    } else if (found < LOCAL_PAIRS) {
        local[found] = pair;
    }
    found = found + 1u;
}

void visitRange(uint a, uint begin, uint end) {
    visited = a;
    vec4 sphere = position[a];
    real4 pa = real4(sphere);
    bool fixedHere = HAS(FIXED) && isFixed(velocity[a]);
    for (uint b = begin; b < end; b += LANES) {
        uintRow at = ROWS_UP_TO(b, end);
        real radius = HAS(RADII) ? ROW(sortedRadius, at) : real(params.radius);
        real4 pb = real4(ROW(sortedX, at), ROW(sortedY, at), ROW(sortedZ, at), radius);
        real3 d = separation(real3(pa), real3(pb));
        real touch = radiusSum(pa, pb);
        real reach = touch + params.margin;
        real squared = dot3(d, d);
        mask listed = IN_ROWS(at) && squared < reach * reach;
        if (!anyLane(listed)) continue;
        if (fixedHere) listed = listed && !isFixed(ROW(velocity, at));
        if (lost(sphere)) return;
        listed = listed && !lost(pb);
        real close = touch + smallerRadius(pa, pb) * FAR_GAP;
        EACH_LANE_WITH(listed, squared >= close * close, addPair, at)
    }
}

#include "shared/group.h"

LANE_LOOP_KERNEL(allCells() / 8u) {
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
    uint start = count == 0u ? 0u : atomicAdd(counters[COUNTER_CANDIDATES], count);
    bool fits = count <= params.pairCapacity && start <= params.pairCapacity - count;
    if (!fits) {  // list_order.comp makes no lists then
        groupRange[invocation] = uvec2(start, 0u);
        return;
    }
    found = 0u;
    if (count <= LOCAL_PAIRS) {
        for (; found < count; ++found) candidates[start + found] = local[found];
    } else {
        base = start;
        visitGroupNumber(invocation, sampleRound);
    }
    // Mesa's software renderer ends the loops of an invocation after 65,535 iterations together.
    if (found < count) atomicAdd(counters[COUNTER_CUT_SHORT], 1u);
    groupRange[invocation] = uvec2(start, found);
}
