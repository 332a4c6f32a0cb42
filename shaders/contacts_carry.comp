// Before the lists are rebuilt: notes each contact that remembers something with its owner, by ids. `phase` is the
// level and the colour of the bundles.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/grid.h"
#include "shared/bundles.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uint, bundles)
BUFFER(readonly, uvec2, pairs)
BUFFER(readonly, float, contactX)
BUFFER(readonly, float, contactY)
BUFFER(readonly, float, contactZ)
BUFFER(coherent, uint, counters)
BUFFER(coherent, uint, carriedCount)  // by id: contacts of the owner, and above them the number of the lists
BUFFER(writeonly, uvec2, carried)     // by id, CARRIED_MOST each: id of the partner, number of the pair

#include "shared/bundle_words.h"
#include "shared/carried.h"
#include "shared/contact_memory.h"
#include "shared/contact_owner.h"

PRIVATE(uint, noted)

bool beginBundle(uint bundle) {
    noted = 0u;
    return hasList(bundle) && listedPairs(bundle) > 0u;
}

void endBundle(uint bundle) {
    if (noted > 0u) atomicAdd(counters[COUNTER_CARRIED], noted);
}

void visitPairs(uint a, uint b, uint at) {
    uint memory = previousHalf() + at;
    if (contactX[memory] == 0.0f && contactY[memory] == 0.0f && contactZ[memory] == 0.0f) return;
    noted = noted + 1u;
    bool first = firstOwnsContact(a, b);
    uint owner = idOf(idAndMaterial[first ? a : b]);
    uint partner = idOf(idAndMaterial[first ? b : a]);
    uint count = carriedBy(owner);
    if (count == CARRIED_MOST) return;
    carriedCount[owner] = (counters[COUNTER_LISTS] << 8u) | (count + 1u);
    carried[owner * CARRIED_MOST + count] = uvec2(partner | (first ? FIRST_OWNS : 0u), at);
}

PAIR_KERNEL
