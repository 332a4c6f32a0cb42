// Puts the pairs of each bundle in order (shared/bundles.h): chooses a batch for each candidate, then copies the
// candidates to their places, the close pairs of each batch first. `phase` is the level of the bundles. On a GPU, each
// block of a bundle has a thread that chooses, because blocks of one colour share no sphere. Then each chunk of a block,
// one or several of its groups of cells, has a thread that copies.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/grid.h"
#include "shared/bundles.h"
#include "shared/candidate.h"

BUFFER(readonly, uvec2, groupRange)
BUFFER(coherent, uvec2, candidates)
BUFFER(restrict, uint, busyBatches)  // by colour and slot: the batches that hold the sphere, and busyTag() above them
BUFFER(coherent, uint, counters)
BUFFER(writeonly, uvec2, pairs)
BUFFER(writeonly, uint, bundles)

#include "shared/movers.h"

#define ALL_BATCHES 0xffffffu     // BATCHES bits
#define ALL_HASHED 0xffffu        // HASHED_BATCHES bits
#define ALONE BATCHES             // the batch of a pair for which none is free

#define OTHER_ITERATIONS 4096u        // more than all loops have that do not visit candidates
#define ITERATIONS_ALONE 8u           // more than the loops of a solver have for a pair that comes alone
#define PLACES (2u * (BATCHES + 1u))  // of a chunk, by batch: close pairs, far pairs
#define CHUNKS min(THREADS, 8u)       // of a block
#define MOST_ROWS (BLOCKS_PER_BUNDLE * 8u)

// By block and chunk: first the number of pairs of each place, then the next place in `pairs`.
SHARED(uint, places[MOST_ROWS * PLACES])
SHARED(uint, placeSizes[PLACES])  // then the first pair of each place
SHARED(bool, isListed)

uint colourOf(uint bundle) {
    return (bundle - params.levelBundles[phase].x) / bundlesOfColour(phase);
}

// Marks the words of these lists. list_reference.comp clears all words for the lists of all spheres.
uint busyTag() {
    return phase + 1u + (moversAlone() ? counters[COUNTER_MOVER_LISTS] : 0u);
}

uint busyOf(uint row) {
    uint word = busyBatches[row];
    return word >> 24u == busyTag() ? word & ALL_BATCHES : 0u;
}

// The first free batch from the hash on, among the hashed ones; then any.
uint freeBatch(uint busy, uint hash) {
    uint hashed = busy & ALL_HASHED;
    if (hashed == ALL_HASHED) return busy == ALL_BATCHES ? ALONE : uint(findLSB(~busy));
    uint turned = (hashed | (hashed << HASHED_BATCHES)) >> hash;
    return (hash + uint(findLSB(~turned))) % HASHED_BATCHES;
}

// `busyRow`: the first row of `busyBatches` of the bundle's colour. `row`: the first place of the chunk.
void chooseBatch(uint k, uint busyRow, uint row) {
    uvec2 candidate = candidates[k];
    uint a = busyRow + firstSphere(candidate);
    uint b = busyRow + secondSphere(candidate);
    uint busyA = busyOf(a);
    uint busyB = busyOf(b);
    uint batch = freeBatch(busyA | busyB, hashOf(candidate));
    if (batch != ALONE) {
        busyBatches[a] = (busyTag() << 24u) | busyA | (1u << batch);
        busyBatches[b] = (busyTag() << 24u) | busyB | (1u << batch);
    }
    uint place = 2u * batch + (isFarPair(candidate) ? 1u : 0u);
    places[row + place] = places[row + place] + 1u;
    candidates[k] = withPlace(candidate, place);
}

void copyToPlace(uint k, uint row) {
    uvec2 candidate = candidates[k];
    uint place = row + placeOf(candidate);
    pairs[places[place]] = uvec2(firstSphere(candidate), secondSphere(candidate));
    places[place] = places[place] + 1u;
}

// Visits the candidates of the groups `first` .. `end - 1` (0 .. 8) of a block.
void visitGroups(uint bundle, uint part, uint first, uint end, bool copying) {
    uvec4 cells = cellsOf(phase);
    BlockPlace block = blockOfBundle(bundle, phase, part);
    uint busyRow = colourOf(bundle) * params.spheres;
    for (uint group = first; group < end && block.exists; ++group) {
        uvec2 range = groupRange[groupOfBlock(cells, block, group)];
        uint row = (part * CHUNKS + group * CHUNKS / 8u) * PLACES;
        for (uint k = firstCandidate(range); k < firstCandidate(range) + candidatesOf(range); ++k) {
            if (copying)
                copyToPlace(k, row);
            else
                chooseBatch(k, busyRow, row);
        }
    }
}

// Returns true if the device would end the loops over the candidates early. The threads of the blocks are in one vector:
// an iteration of one of them is one of all.
bool hasTooManyCandidates(uint bundle) {
    if (LOOP_LIMIT == NO_LOOP_LIMIT) return false;
    uvec4 cells = cellsOf(phase);
    uint candidatesInTurn = 0u;
    for (uint group = 0u; group < 8u; ++group) {
        uint most = 0u;
        for (uint part = 0u; part < BLOCKS_PER_BUNDLE; ++part) {
            BlockPlace block = blockOfBundle(bundle, phase, part);
            if (block.exists) most = max(most, candidatesOf(groupRange[groupOfBlock(cells, block, group)]));
        }
        candidatesInTurn = candidatesInTurn + most;
    }
    return candidatesInTurn > (LOOP_LIMIT - OTHER_ITERATIONS) / 2u;  // they are visited twice
}

// Finds room for the pairs, and where the pairs of each place begin. Returns false if there is no list.
bool divideRoom(uint words) {
    uint total = 0u;
    for (uint place = 0u; place < PLACES; ++place) total = total + placeSizes[place];
    if (total == 0u) return false;
    uint alone = placeSizes[2u * ALONE] + placeSizes[2u * ALONE + 1u];  // pairs that come one by one
    if (LOOP_LIMIT != NO_LOOP_LIMIT && alone > LOOP_LIMIT / ITERATIONS_ALONE) {
        atomicAdd(counters[COUNTER_CUT_SHORT], 1u);
        return false;
    }
    uint start = atomicAdd(counters[COUNTER_PAIRS], total + PAIR_PADDING);
    uint limit = counters[COUNTER_PAIR_LIMIT];
    if (total + PAIR_PADDING > limit || start > limit - total - PAIR_PADDING) return false;
    bundles[words] = start;
    bundles[words + 1u] = total;
    for (uint place = 0u; place < PLACES; ++place) {
        uint count = placeSizes[place];
        placeSizes[place] = start;
        start = start + count;
        if (place % 2u != 0u) bundles[words + 4u + place / 2u] = start;
    }
    return true;
}

BUNDLE_KERNEL(8u * bundlesOfColour(phase)) {
    uint bundle = params.levelBundles[phase].x + invocation;
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
    uint rows = BLOCKS_PER_BUNDLE * CHUNKS;
    for (uint at = THREAD; at < rows * PLACES; at += THREADS) places[at] = 0u;
    BARRIER
    for (uint part = THREAD; part < BLOCKS_PER_BUNDLE; part += THREADS) visitGroups(bundle, part, 0u, 8u, false);
    BUFFER_BARRIER
    for (uint place = THREAD; place < PLACES; place += THREADS) {
        uint sum = 0u;
        for (uint row = 0u; row < rows; ++row) sum = sum + places[row * PLACES + place];
        placeSizes[place] = sum;
    }
    BARRIER
    if (FIRST_THREAD) isListed = divideRoom(words);
    BARRIER
    if (!isListed) return;
    for (uint place = THREAD; place < PLACES; place += THREADS) {
        uint next = placeSizes[place];
        for (uint at = place; at < rows * PLACES; at += PLACES) {
            uint count = places[at];
            places[at] = next;
            next = next + count;
        }
    }
    BARRIER
    for (uint row = THREAD; row < rows; row += THREADS) {
        uint chunk = row % CHUNKS;
        visitGroups(bundle, row / CHUNKS, chunk * 8u / CHUNKS, (chunk + 1u) * 8u / CHUNKS, true);
    }
}
