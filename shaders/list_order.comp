// Puts the pairs of each bundle in order (shared/bundles.h): chooses a batch for each candidate, then copies the
// candidates to their places, the close pairs of each batch first. `phase` is the level and the colour of the bundles.
//
// The threads of a work group take the candidates in tiles, one each. A candidate that shares a sphere with an earlier
// one of its tile waits for that one's choice, so the order does not depend on the number of threads.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/grid.h"
#include "shared/bundles.h"

BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uvec2, groupRange)
BUFFER(restrict, uvec2, candidates)  // a thread reads back only what it has written
BUFFER(coherent, uint, busyBatches)  // the batches that hold the sphere, and the phase in which they do
BUFFER(coherent, uint, counters)
BUFFER(writeonly, uvec2, pairs)
BUFFER(writeonly, uint, bundles)

#define FAR_BIT 0x80000000u
#define SLOT_BITS 0xffffffu
#define ALL_BATCHES 0xffffffu     // BATCHES bits
#define ALL_HASHED 0xffffu        // HASHED_BATCHES bits
#define ALONE BATCHES             // the batch of a pair for which none is free

#define PLACES (2u * (BATCHES + 1u))
#define GROUPS_PER_BUNDLE (8u * BLOCKS_PER_BUNDLE)
#define UNDECIDED 0xffffffffu
#define NONE 0xffffffffu
#define UNROLLED 8u  // passes of a loop that compilers unroll; divides THREADS

SHARED(uint, groupEnd[GROUPS_PER_BUNDLE])     // candidates of the bundle up to the end of the group
SHARED(uint, groupOffset[GROUPS_PER_BUNDLE])  // from the number of a candidate in the bundle to its index
SHARED(uint, places[PLACES])         // by batch, close pairs and far pairs: first how many, then the next place
SHARED(uint, firstPlace)             // NONE if there is no room
SHARED(uint, undecided)              // candidates of the tile whose batch is not chosen
SHARED(uint, cutShort)               // 1 if a loop has ended early, and places of the list are wrong
SHARED(uvec2, tilePair[THREADS])
SHARED(uint, tileChoice[THREADS])    // batch, later place

PRIVATE(uint, groupOfThread)         // of the candidate of the thread

uint hashOf(uint a, uint b) {
    uint ia = idOf(idAndMaterial[a]);
    uint ib = idOf(idAndMaterial[b]);
    uint hash = min(ia, ib) * 0x9e3779b1u ^ (max(ia, ib) + 0x7f4a7c15u) * 0x85ebca6bu;
    hash ^= hash >> 15u;
    hash *= 0x2c1b3c6du;
    hash ^= hash >> 12u;
    return hash % HASHED_BATCHES;
}

uint busyOf(uint sphere) {
    uint word = busyBatches[sphere];
    return word >> 24u == phase + 1u ? word & ALL_BATCHES : 0u;
}

// The first free batch from the hash on, among the hashed ones; then any.
uint freeBatch(uint busy, uint hash) {
    uint hashed = busy & ALL_HASHED;
    if (hashed == ALL_HASHED) return busy == ALL_BATCHES ? ALONE : uint(findLSB(~busy));
    uint turned = (hashed | (hashed << HASHED_BATCHES)) >> hash;
    return (hash + uint(findLSB(~turned))) % HASHED_BATCHES;
}

uint placeOf(uvec2 candidate) {
    return candidate.y >> 24u;
}

// The index of candidate `number` of the bundle. Numbers come in ascending order.
uint candidateAt(uint number) {
    while (number >= groupEnd[groupOfThread]) groupOfThread = groupOfThread + 1u;
    return number + groupOffset[groupOfThread];
}

// Notes the candidates of each group. Returns their sum.
uint noteCandidates(uint bundle) {
    uint level = levelOfPhase();
    uvec4 cells = cellsOf(level);
    for (uint k = THREAD; k < GROUPS_PER_BUNDLE; k += THREADS) {
        BlockPlace block = blockOfBundle(bundle, level, k / 8u);
        uvec2 range = block.exists ? groupRange[groupOfBlock(cells, block, k % 8u)] : uvec2(0u, 0u);
        groupOffset[k] = firstCandidate(range);
        groupEnd[k] = candidatesOf(range);
    }
    for (uint k = THREAD; k < PLACES; k += THREADS) places[k] = 0u;
    BARRIER
    if (FIRST_THREAD) {
        uint sum = 0u;
        for (uint k = 0u; k < GROUPS_PER_BUNDLE; ++k) {
            groupOffset[k] = groupOffset[k] - sum;
            sum = sum + groupEnd[k];
            groupEnd[k] = sum;
        }
    }
    BARRIER
    return groupEnd[GROUPS_PER_BUNDLE - 1u];
}

// Chooses the batches of the candidates from number `tile` on, one for each thread.
void chooseBatches(uint tile, uint total) {
    bool mine = tile + THREAD < total;
    uint k = mine ? candidateAt(tile + THREAD) : 0u;
    uvec2 pair = mine ? candidates[k] : uvec2(NONE, NONE);
    uint a = pair.x & SLOT_BITS;
    uint b = pair.y;
    uint busyA = mine ? busyOf(a) : 0u;
    uint busyB = mine ? busyOf(b) : 0u;
    uint hash = mine ? hashOf(a, b) : 0u;
    tilePair[THREAD] = uvec2(mine ? a : NONE, b);
    tileChoice[THREAD] = UNDECIDED;
    if (FIRST_THREAD) undecided = min(THREADS, total - tile);
    BARRIER
    uint waits[2];  // bits of the earlier candidates that share a sphere
    waits[0] = 0u;
    waits[1] = 0u;
    bool lastOfA = true;
    bool lastOfB = true;
    for (uint first = 0u; first < THREADS && mine && THREADS > 1u; first += UNROLLED) {
        for (uint other = first; other < first + UNROLLED; ++other) {
            uvec2 spheres = tilePair[other];
            bool sharesA = spheres.x == a || spheres.y == a;
            bool sharesB = spheres.x == b || spheres.y == b;
            if (other > THREAD) {
                lastOfA = lastOfA && !sharesA;
                lastOfB = lastOfB && !sharesB;
            } else if (other < THREAD && (sharesA || sharesB)) {
                waits[other / 32u] = waits[other / 32u] | (1u << (other % 32u));
            }
        }
    }
    uint batch = UNDECIDED;
    bool waiting = mine;
    // In each round, at least the first undecided candidate chooses.
    for (uint round = 0u; round < THREADS; ++round) {
        bool chooses = waiting;
        for (uint word = 0u; word < 2u && THREADS > 1u; ++word) {
            while (chooses && waits[word] != 0u) {
                uint other = uint(findLSB(waits[word])) + 32u * word;
                uint choice = tileChoice[other];
                chooses = choice != UNDECIDED;
                if (!chooses) break;
                waits[word] = waits[word] & (waits[word] - 1u);
                uint bit = choice == ALONE ? 0u : 1u << choice;
                uvec2 spheres = tilePair[other];
                if (spheres.x == a || spheres.y == a) busyA = busyA | bit;
                if (spheres.x == b || spheres.y == b) busyB = busyB | bit;
            }
        }
        if (chooses) batch = freeBatch(busyA | busyB, hash);
        BARRIER
        if (chooses) {
            tileChoice[THREAD] = batch;
            waiting = false;
            ADD_SHARED(undecided, UNDECIDED)  // - 1
        }
        BARRIER
        if (undecided == 0u) break;
    }
    if (mine) {
        uint bit = batch == ALONE ? 0u : 1u << batch;
        if (lastOfA) busyBatches[a] = ((phase + 1u) << 24u) | busyA | bit;
        if (lastOfB) busyBatches[b] = ((phase + 1u) << 24u) | busyB | bit;
        uint place = 2u * batch + (pair.x >= FAR_BIT ? 1u : 0u);
        ADD_SHARED(places[place], 1u)
        candidates[k] = uvec2(pair.x, pair.y | (place << 24u));
    }
    BUFFER_BARRIER
}

// Copies the candidates from number `tile` on to their places, one for each thread.
void copyToPlaces(uint tile, uint total) {
    bool mine = tile + THREAD < total;
    uvec2 pair = mine ? candidates[candidateAt(tile + THREAD)] : uvec2(0u, 0u);
    uint place = mine ? placeOf(pair) : UNDECIDED;
    tileChoice[THREAD] = place;
    BARRIER
    uint rank = 0u;
    bool last = mine;
    for (uint first = 0u; first < THREADS && mine && THREADS > 1u; first += UNROLLED) {
        for (uint other = first; other < first + UNROLLED; ++other) {
            if (other == THREAD || tileChoice[other] != place) continue;
            if (other < THREAD)
                rank = rank + 1u;
            else
                last = false;
        }
    }
    if (mine) pairs[places[place] + rank] = uvec2(pair.x & SLOT_BITS, pair.y & SLOT_BITS);
    BARRIER
    if (last) places[place] = places[place] + rank + 1u;
}

BUNDLE_KERNEL(bundlesOfPhase()) {
    uint bundle = bundleOfPhase(invocation);
    uint words = bundle * BUNDLE_WORDS;
    if (FIRST_THREAD) {
        bundles[words] = 0u;
        bundles[words + 1u] = 0u;
        bundles[words + 2u] = 1u;
    }
    if (counters[COUNTER_CANDIDATES] > params.pairCapacity) return;  // list_fit.comp
    uint total = noteCandidates(bundle);
    if (total == 0u) return;
    uint tiles = 0u;
    groupOfThread = 0u;
    if (FIRST_THREAD) cutShort = 0u;
    for (uint tile = 0u; tile < total; tile += THREADS) {
        chooseBatches(tile, total);
        tiles = tiles + 1u;
    }
    if (FIRST_THREAD) {
        uint start = atomicAdd(counters[COUNTER_PAIRS], total + PAIR_PADDING);
        bool fits = total + PAIR_PADDING <= params.pairCapacity && start <= params.pairCapacity - total - PAIR_PADDING;
        uint placed = 0u;
        for (uint k = 0u; k < PLACES; ++k) placed = placed + places[k];
        if (placed != total) cutShort = 1u;
        fits = fits && placed == total;
        firstPlace = fits ? start : NONE;
        if (fits) {
            bundles[words] = start;
            bundles[words + 1u] = total;
            for (uint batch = 0u; batch <= BATCHES; ++batch) {
                uint close = places[2u * batch];
                uint far = places[2u * batch + 1u];
                places[2u * batch] = start;
                places[2u * batch + 1u] = start + close;
                start = start + close + far;
                bundles[words + 4u + batch] = start;
            }
        }
    }
    BARRIER
    // One tile more than there are: as in list_build.comp, loops may have ended early.
    groupOfThread = 0u;
    for (uint tile = 0u; tile < total + THREADS && firstPlace != NONE; tile += THREADS) {
        copyToPlaces(tile, total);
        tiles = tiles + 1u;
    }
    if (firstPlace != NONE && tiles != 2u * ((total + THREADS - 1u) / THREADS) + 1u) cutShort = 1u;
    BARRIER
    if (!FIRST_THREAD || cutShort == 0u) return;
    bundles[words + 1u] = 0u;  // places of the list are not written
    atomicAdd(counters[COUNTER_CUT_SHORT], 1u);
}
