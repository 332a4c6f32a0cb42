// Before the lists are rebuilt: notes each contact that remembers something with its owner, by ids. For lists of movers
// alone, these are the contacts of movers, whose pairs in the lists of all spheres end (shared/movers.h). `phase` is 0 to
// clear the counts of their owners first.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/grid.h"
#include "shared/bundles.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uint, bundles)
BUFFER(restrict, uvec2, pairs)
BUFFER(coherent, uint, counters)
BUFFER(coherent, uint, carriedCount)  // by id: see carried.h
BUFFER(writeonly, uvec2, carried)     // by id, CARRIED_MOST each: id of the partner, number of the pair
BUFFER(readonly, uint, isMover)
BUFFER(readonly, uint, leftBlock)

#include "shared/bundle_words.h"
#include "shared/carried.h"
#include "shared/contact_owner.h"
#include "shared/movers.h"
#include "shared/left_block.h"

// A thread reads so many pairs, then adds to their counters, then writes their rows. Between the reads and writes of
// each pair, an atomic addition would make a CPU wait for them.
#define AT_ONCE (THREADS == 1u ? 32u : 1u)

bool endsHere(uvec2 pair) {
    return isMover[pair.x] != 0u || isMover[SECOND_OF(pair)] != 0u;
}

BUNDLE_KERNEL(params.bundles) {
    if (!hasList(invocation) || listedPairs(invocation) == 0u) return;
    bool ends = moversAlone() && invocation < firstBuiltBundle();  // pairs of the lists of all spheres
    if (ends && !wasLeft(invocation)) return;
    uint owners[AT_ONCE];
    uint places[AT_ONCE];
    uvec2 rows[AT_ONCE];
    uint noted = 0u;
    uint end = endOfPairs(invocation);
    for (uint from = firstPair(invocation) + THREAD; from < end; from += THREADS * AT_ONCE) {
        uint count = 0u;
        for (uint k = from; k < min(end, from + THREADS * AT_ONCE); k += THREADS) {
            uvec2 pair = pairs[k];
            if (ends && !endsHere(pair)) continue;
            if (ends && phase != 0u) pairs[k].y = params.farSlot;
            if ((pair.y & PAIR_REMEMBERS) == 0u) continue;
            uint a = pair.x;
            uint b = SECOND_OF(pair);
            bool first = firstOwnsContact(a, b);
            owners[count] = idOf(idAndMaterial[first ? a : b]);
            rows[count] = uvec2(partnerWord(idOf(idAndMaterial[first ? b : a])) | (first ? FIRST_OWNS : 0u), k);
            count = count + 1u;
        }
        if (phase == 0u) {
            for (uint j = 0u; j < count; ++j) atomicExchange(carriedCount[owners[j]], 0u);
            continue;
        }
        for (uint j = 0u; j < count; ++j) places[j] = countIn(atomicAdd(carriedCount[owners[j]], oneMoreCarried()));
        for (uint j = 0u; j < count; ++j)
            if (places[j] < CARRIED_MOST) carried[owners[j] * CARRIED_MOST + places[j]] = rows[j];
        noted = noted + count;
    }
    if (noted > 0u) atomicAdd(counters[COUNTER_CARRIED], noted);
}
