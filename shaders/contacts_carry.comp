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

BUNDLE_KERNEL(params.bundles) {
    if (!hasList(invocation) || listedPairs(invocation) == 0u) return;
    uint noted = 0u;
    for (uint k = firstPair(invocation) + THREAD; k < endOfPairs(invocation); k += THREADS) {
        if (!REMEMBERS(pairs, k)) continue;
        noted = noted + 1u;
        uint a = pairs[k].x;
        uint b = SECOND_OF(pairs[k]);
        bool first = firstOwnsContact(a, b);
        uint owner = idOf(idAndMaterial[first ? a : b]);
        uint partner = idOf(idAndMaterial[first ? b : a]);
        uint place = countIn(atomicAdd(carriedCount[owner], oneMoreCarried()));
        if (place < CARRIED_MOST) carried[owner * CARRIED_MOST + place] = uvec2(partner | (first ? FIRST_OWNS : 0u), k);
    }
    if (noted > 0u) atomicAdd(counters[COUNTER_CARRIED], noted);
}
