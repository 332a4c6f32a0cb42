// Finds the pairs of each group of 2 x 2 x 2 cells whose gap is below the margin, or larger for movers
// (shared/mover_reach.h): the candidates. Pairs of fixed spheres are left out. The threads of a work group take equal
// shares of the group's spheres. The first walk of a thread fills a local array, which is then copied. A thread with more
// pairs walks a second time.
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
#include "shared/candidate.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, float, sortedX)
BUFFER(readonly, float, sortedY)
BUFFER(readonly, float, sortedZ)
BUFFER(readonly, float, sortedRadius)
BUFFER(readonly, uint, cellStart)
BUFFER(coherent, uint, counters)
BUFFER(writeonly, uvec2, candidates)  // see candidate.h
BUFFER(writeonly, uvec2, groupRange)  // first candidate, candidates
BUFFER(readonly, uint, cellOrder)
BUFFER(readonly, uint, isMover)
BUFFER(readonly, vec4, listReference)

#define LOCAL_PAIRS (THREADS == 1u ? 192u : 32u)
// Pairs with a gap above this share of the smaller radius are far. They come last in their batch, so that pairs that
// touch are together in the lanes of the solver.
#define FAR_GAP 0.05f
// The counter of candidates stays below 2^32: beyond this value, nothing is added.
#define MOST_COUNTED 0x80000000u
PRIVATE(uint, found)
PRIVATE(uint, base)      // index of the first pair; UNLISTED during the first walk
PRIVATE(uvec2, local[LOCAL_PAIRS])

PRIVATE(uint, visitedEntry)  // of the sphere whose range is visited
PRIVATE(uint, visited)       // its slot
PRIVATE(uint, visitedId)
PRIVATE(float, visitedReach)  // beyond the radii (m)

SHARED(uint, firstOfThread[THREADS])  // first the number of pairs of each thread, then the number of those before it
SHARED(uint, groupPairs)
SHARED(uint, groupStart)
SHARED(bool, fits)
SHARED(uint, cutShort)

#include "shared/entries.h"
#include "shared/mover_reach.h"

float moreReach(uint slot) {
    return moreMotionOf(listReference[slot].w);
}

bool isNear(uint a, uint b, float most) {
    vec3 d = separation(vec3(position[a]), vec3(position[b]));
    float reach = radiusSum(position[a], position[b]) + most;
    return dot3(d, d) < reach * reach;
}

void addPair(uint entry, bool isFar) {
    if (isOldEntry(visitedEntry, entry)) return;
    uint b = slotOfEntry(entry);
    if (isEntryOfMover(entry) && !isNear(visited, b, visitedReach + moreReach(b))) return;
    uvec2 pair = candidateOf(visited, b, isFar, batchHash(visitedId, idOf(idAndMaterial[b])));
    if (base != UNLISTED) {
        candidates[base + found] = pair;
    } else if (found < LOCAL_PAIRS) {
        local[found] = pair;
    }
    found = found + 1u;
}

void visitRange(uint a, uint begin, uint end) {
    visitedEntry = a;
    visited = slotOfEntry(a);
    visitedId = idOf(idAndMaterial[visited]);
    vec4 sphere = position[visited];
    visitedReach = params.margin + moreReach(visited);
    float farthest = visitedReach + (isEntryOfMover(begin) ? mostMoreMotion() : 0.0f);
    real4 pa = real4(sphere);
    bool fixedHere = HAS(FIXED) && isFixed(velocity[visited]);  // a mover is not fixed
    for (uint b = begin; b < end; b += LANES) {
        uintRow at = ROWS_UP_TO(b, end);
        real radius = HAS(RADII) ? ROW(sortedRadius, at) : real(params.radius);
        real4 pb = real4(ROW(sortedX, at), ROW(sortedY, at), ROW(sortedZ, at), radius);
        real3 d = separation(real3(pa), real3(pb));
        real touch = radiusSum(pa, pb);
        real reach = touch + farthest;
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

#define FOR_LISTS
#include "shared/group.h"
#undef FOR_LISTS

// Finds room for the pairs of the group.
void reserve() {
    groupPairs = 0u;
    uint k = 0u;
    for (; k < THREADS; ++k) {
        uint count = firstOfThread[k];
        firstOfThread[k] = groupPairs;
        groupPairs = groupPairs + count;
    }
    cutShort = k < THREADS ? 1u : 0u;
    groupStart = params.pairCapacity;
    if (SEEN(counters[COUNTER_CANDIDATES]) < MOST_COUNTED)
        groupStart = atomicAdd(counters[COUNTER_CANDIDATES], groupPairs);
    // If it does not fit, list_order.comp makes no lists.
    fits = cutShort == 0u && groupPairs <= params.pairCapacity && groupStart <= params.pairCapacity - groupPairs;
}

LANE_BUNDLE_KERNEL(allCells() / 8u) {
    uint group = firstBuiltCell() / 8u + invocation;
    uvec4 cells = cellsOf(levelOfGroup(group));
    if (spheresOfGroup(cells, placeOfGroup(cells, group)) == 0u) {
        if (FIRST_THREAD) groupRange[group] = uvec2(0u, 0u);
        return;
    }
    uint sampleRound = counters[COUNTER_REBUILDS];
    base = UNLISTED;
    uint count = 0u;
    for (uint walk = 0u; walk < 2u; ++walk) {
        found = 0u;
        sampled = 0u;
        // The second walk is for threads with more pairs than the array holds.
        if (walk == 0u || (fits && count > LOCAL_PAIRS)) visitShareOfGroup(group, THREAD, THREADS, sampleRound);
        if (walk > 0u) continue;
        count = found;
        if (sampled > 0u) {
            // Each new list takes another share of the pairs. So there must be new lists in each substep.
            atomicAdd(counters[COUNTER_SAMPLED], sampled);
            atomicOr(counters[COUNTER_REBUILD], REBUILD_DUE | REBUILD_ALL);
        }
        firstOfThread[THREAD] = count;
        BARRIER
        if (FIRST_THREAD) reserve();
        BARRIER
        base = groupStart + firstOfThread[THREAD];
        found = 0u;  // also if the renderer ends the loop here
    }
    if (fits && count <= LOCAL_PAIRS)
        for (; found < count; ++found) candidates[base + found] = local[found];
    // Mesa's software renderer ends the loops of an invocation after 65,535 iterations together.
    if (fits && found < count) atomicOr(cutShort, 1u);
    BARRIER
    if (!FIRST_THREAD) return;
    if (cutShort != 0u) atomicAdd(counters[COUNTER_CUT_SHORT], 1u);
    groupRange[group] = uvec2(groupStart, fits && cutShort == 0u ? groupPairs : 0u);
}
