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

#define OTHER_ITERATIONS 1024u        // more than all loops have that do not visit candidates
#define ITERATIONS_ALONE 8u           // more than the loops of a solver have for a pair that comes alone
#define PLACES (2u * (BATCHES + 1u))  // of a block, by batch: close pairs, far pairs

SHARED(uint, places[BLOCKS_PER_BUNDLE * PLACES])  // by block: first the number of its pairs, then the next place
SHARED(bool, isListed)

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
    for (uint group = 0u; group < 8u && block.exists; ++group) {
        uvec2 range = groupRange[groupOfBlock(cells, block, group)];
        for (uint k = firstCandidate(range); k < firstCandidate(range) + candidatesOf(range); ++k) {
            if (copying)
                copyToPlace(part, k);
            else
                chooseBatch(part, k);
        }
    }
}

// Returns true if the device would end the loops over the candidates early. The threads of the blocks are in one vector:
// an iteration of one of them is one of all.
bool hasTooManyCandidates(uint bundle) {
    if (LOOP_LIMIT == NO_LOOP_LIMIT) return false;
    uint level = levelOfPhase();
    uvec4 cells = cellsOf(level);
    uint candidatesInTurn = 0u;
    for (uint group = 0u; group < 8u; ++group) {
        uint most = 0u;
        for (uint part = 0u; part < BLOCKS_PER_BUNDLE; ++part) {
            BlockPlace block = blockOfBundle(bundle, level, part);
            if (block.exists) most = max(most, candidatesOf(groupRange[groupOfBlock(cells, block, group)]));
        }
        candidatesInTurn = candidatesInTurn + most;
    }
    return candidatesInTurn > (LOOP_LIMIT - OTHER_ITERATIONS) / 2u;  // they are visited twice
}

// Finds room for the pairs, and where the pairs of each batch and block begin. Returns false if there is no list.
bool divideRoom(uint words) {
    uint total = 0u;
    uint alone = 0u;  // pairs that come one by one
    for (uint at = 0u; at < BLOCKS_PER_BUNDLE * PLACES; ++at) {
        total = total + places[at];
        if (at % PLACES / 2u == ALONE) alone = alone + places[at];
    }
    if (total == 0u) return false;
    if (LOOP_LIMIT != NO_LOOP_LIMIT && alone > LOOP_LIMIT / ITERATIONS_ALONE) {
        atomicAdd(counters[COUNTER_CUT_SHORT], 1u);
        return false;
    }
    uint start = atomicAdd(counters[COUNTER_PAIRS], total + PAIR_PADDING);
    if (total + PAIR_PADDING > params.pairCapacity || start > params.pairCapacity - total - PAIR_PADDING) return false;
    bundles[words] = start;
    bundles[words + 1u] = total;
    for (uint place = 0u; place < PLACES; ++place) {
        for (uint at = place; at < BLOCKS_PER_BUNDLE * PLACES; at += PLACES) {
            uint count = places[at];
            places[at] = start;
            start = start + count;
        }
        if (place % 2u != 0u) bundles[words + 4u + place / 2u] = start;
    }
    return true;
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
    if (hasTooManyCandidates(bundle)) {
        if (FIRST_THREAD) atomicAdd(counters[COUNTER_CUT_SHORT], 1u);
        return;
    }
    for (uint part = THREAD; part < BLOCKS_PER_BUNDLE; part += THREADS) {
        for (uint place = 0u; place < PLACES; ++place) places[part * PLACES + place] = 0u;
        visitCandidates(bundle, part, false);
    }
    BARRIER
    if (FIRST_THREAD) isListed = divideRoom(words);
    BARRIER
    if (!isListed) return;
    for (uint part = THREAD; part < BLOCKS_PER_BUNDLE; part += THREADS) visitCandidates(bundle, part, true);
}
