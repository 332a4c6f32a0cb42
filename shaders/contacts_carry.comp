// Before the lists are rebuilt: notes each contact that remembers something with its owner, by ids.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uint, bundles)
BUFFER(readonly, uvec2, pairs)
BUFFER(readonly, float, contactX)
BUFFER(readonly, float, contactY)
BUFFER(readonly, float, contactZ)
BUFFER(coherent, uint, counters)
BUFFER(coherent, uint, carriedCount)  // by id: see carried.h
BUFFER(writeonly, uvec2, carried)     // by id, CARRIED_MOST each: id of the partner, number of the pair

#include "shared/bundle_words.h"
#include "shared/carried.h"
#include "shared/contact_memory.h"
#include "shared/contact_owner.h"

BUNDLE_KERNEL(params.bundles) {
    if (!hasList(invocation) || listedPairs(invocation) == 0u) return;
    uint noted = 0u;
    uint previous = previousHalf();
    for (uint k = firstPair(invocation) + THREAD; k < endOfPairs(invocation); k += THREADS) {
        uint memory = previous + k;
        if (contactX[memory] == 0.0f && contactY[memory] == 0.0f && contactZ[memory] == 0.0f) continue;
        noted = noted + 1u;
        uvec2 pair = pairs[k];
        bool first = firstOwnsContact(pair.x, pair.y);
        uint owner = idOf(idAndMaterial[first ? pair.x : pair.y]);
        uint partner = idOf(idAndMaterial[first ? pair.y : pair.x]);
        uint place = countIn(atomicAdd(carriedCount[owner], oneMoreCarried()));
        if (place < CARRIED_MOST) carried[owner * CARRIED_MOST + place] = uvec2(partner | (first ? FIRST_OWNS : 0u), k);
    }
    if (noted > 0u) atomicAdd(counters[COUNTER_CARRIED], noted);
}
