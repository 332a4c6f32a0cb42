// Before the lists are rebuilt: notes each contact that remembers something with its owner, by ids.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uint, bundles)
BUFFER(readonly, uvec2, pairs)
BUFFER(coherent, uint, counters)
BUFFER(coherent, uint, carriedCount)  // by id: see carried.h
BUFFER(writeonly, uvec2, carried)     // by id, CARRIED_MOST each: id of the partner, number of the pair

#include "shared/bundle_words.h"
#include "shared/carried.h"
#include "shared/contact_owner.h"

// A thread reads so many pairs, then adds to their counters, then writes their rows. Between the reads and writes of
// each pair, an atomic addition would make a CPU wait for them.
#define AT_ONCE (THREADS == 1u ? 32u : 1u)

BUNDLE_KERNEL(params.bundles) {
    if (!hasList(invocation) || listedPairs(invocation) == 0u) return;
    uint owners[AT_ONCE];
    uint places[AT_ONCE];
    uvec2 rows[AT_ONCE];
    uint noted = 0u;
    uint end = endOfPairs(invocation);
    for (uint from = firstPair(invocation) + THREAD; from < end; from += THREADS * AT_ONCE) {
        uint count = 0u;
        for (uint k = from; k < min(end, from + THREADS * AT_ONCE); k += THREADS) {
            if ((pairs[k].y & PAIR_REMEMBERS) == 0u) continue;
            uint a = pairs[k].x;
            uint b = SECOND_OF(pairs[k]);
            bool first = firstOwnsContact(a, b);
            owners[count] = idOf(idAndMaterial[first ? a : b]);
            rows[count] = uvec2(idOf(idAndMaterial[first ? b : a]) | (first ? FIRST_OWNS : 0u), k);
            count = count + 1u;
        }
        for (uint j = 0u; j < count; ++j) places[j] = countIn(atomicAdd(carriedCount[owners[j]], oneMoreCarried()));
        for (uint j = 0u; j < count; ++j)
            if (places[j] < CARRIED_MOST) carried[owners[j] * CARRIED_MOST + places[j]] = rows[j];
        noted = noted + count;
    }
    if (noted > 0u) atomicAdd(counters[COUNTER_CARRIED], noted);
}
