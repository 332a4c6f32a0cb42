// Puts the pairs of each bundle in order (shared/bundles.h): chooses a batch for each candidate, then copies the
// candidates to their places, the close pairs of each batch first. `phase` is the level and the colour of the bundles.
// On a GPU, each block of a bundle has a thread: blocks of one colour share no sphere.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/grid.h"
#include "shared/bundles.h"

BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uvec2, groupRange)
BUFFER(restrict, uvec2, candidates)
BUFFER(restrict, uint, busyBatches)  // the batches that hold the sphere, and the phase in which they do
BUFFER(coherent, uint, counters)
BUFFER(writeonly, uvec2, pairs)
BUFFER(writeonly, uint, bundles)

#define FAR_BIT 0x80000000u
#define SLOT_BITS 0xffffffu
#define ALL_BATCHES 0xffffffu     // BATCHES bits
#define ALL_HASHED 0xffffu        // HASHED_BATCHES bits
#define ALONE BATCHES             // the batch of a pair for which none is free

#define PLACES (2u * (BATCHES + 1u))  // of a block, by batch: close pairs, far pairs

SHARED(uint, places[BLOCKS_PER_BUNDLE * PLACES])  // by block: first the number of its pairs, then the next place
SHARED(uint, pairsOfBlock[BLOCKS_PER_BUNDLE])
SHARED(uint, total)
SHARED(uint, start)
SHARED(bool, fits)
SHARED(bool, cutShort)
PRIVATE(uint, visited)  // candidates

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

void chooseBatch(uint part, uint k) {
    uvec2 pair = candidates[k];
    uint a = pair.x & SLOT_BITS;
    uint busyA = busyOf(a);
    uint busyB = busyOf(pair.y);
    uint batch = freeBatch(busyA | busyB, hashOf(a, pair.y));
    if (batch != ALONE) {
        busyBatches[a] = ((phase + 1u) << 24u) | busyA | (1u << batch);
        busyBatches[pair.y] = ((phase + 1u) << 24u) | busyB | (1u << batch);
    }
    uint place = 2u * batch + (pair.x >= FAR_BIT ? 1u : 0u);
    places[part * PLACES + place] = places[part * PLACES + place] + 1u;
    candidates[k] = uvec2(pair.x, pair.y | (place << 24u));
}

void copyToPlace(uint part, uint k) {
    uvec2 pair = candidates[k];
    uint place = part * PLACES + (pair.y >> 24u);
    pairs[places[place]] = uvec2(pair.x & SLOT_BITS, pair.y & SLOT_BITS);
    places[place] = places[place] + 1u;
}

void visitCandidates(uint bundle, uint part, bool copying) {
    uint level = levelOfPhase();
    uvec4 cells = cellsOf(level);
    BlockPlace block = blockOfBundle(bundle, level, part);
    visited = 0u;
    for (uint group = 0u; group < 8u && block.exists; ++group) {
        uvec2 range = groupRange[groupOfBlock(cells, block, group)];
        for (uint k = firstCandidate(range); k < firstCandidate(range) + candidatesOf(range); ++k) {
            if (copying)
                copyToPlace(part, k);
            else
                chooseBatch(part, k);
            visited = visited + 1u;
        }
    }
}

// Finds room for the pairs, and where the pairs of each batch and block begin.
void divideRoom(uint words) {
    total = 0u;
    for (uint part = 0u; part < BLOCKS_PER_BUNDLE; ++part) total = total + pairsOfBlock[part];
    start = total == 0u ? 0u : atomicAdd(counters[COUNTER_PAIRS], total + PAIR_PADDING);
    fits = total > 0u && total + PAIR_PADDING <= params.pairCapacity &&
           start <= params.pairCapacity - total - PAIR_PADDING;
    cutShort = false;
    if (!fits) return;
    uint next = start;
    for (uint place = 0u; place < PLACES; ++place) {
        for (uint at = place; at < BLOCKS_PER_BUNDLE * PLACES; at += PLACES) {
            uint count = places[at];
            places[at] = next;
            next = next + count;
        }
        if (place % 2u != 0u) bundles[words + 4u + place / 2u] = next;
    }
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
    for (uint part = THREAD; part < BLOCKS_PER_BUNDLE; part += THREADS) {
        for (uint place = 0u; place < PLACES; ++place) places[part * PLACES + place] = 0u;
        visitCandidates(bundle, part, false);
        pairsOfBlock[part] = visited;
    }
    BARRIER
    if (FIRST_THREAD) divideRoom(words);
    BARRIER
    if (!fits) return;
    for (uint part = THREAD; part < BLOCKS_PER_BUNDLE; part += THREADS) {
        visitCandidates(bundle, part, true);
        if (visited != pairsOfBlock[part]) cutShort = true;
    }
    BARRIER
    if (!FIRST_THREAD) return;
    // As in list_build.comp: if the loops have ended early, places of the list are not written.
    bundles[words] = start;
    bundles[words + 1u] = cutShort ? 0u : total;
    if (cutShort) atomicAdd(counters[COUNTER_CUT_SHORT], 1u);
}
