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
BUFFER(restrict, uint, carriedCount)  // by id: contacts of the owner, and above them the number of the lists
BUFFER(writeonly, uvec2, carried)     // by id, CARRIED_MOST each: id of the partner, number of the pair

#include "shared/bundle_words.h"
#include "shared/carried.h"
#include "shared/contact_memory.h"
#include "shared/contact_owner.h"

KERNEL(bundlesOfPhase()) {
    uint bundle = bundleOfPhase(invocation);
    if (!hasList(bundle) || listedPairs(bundle) == 0u) return;
    uint previous = previousHalf();
    uint held = 0u;
    for (uint k = firstPair(bundle); k < endOfPairs(bundle); ++k) {
        uint at = previous + k;
        if (contactX[at] == 0.0f && contactY[at] == 0.0f && contactZ[at] == 0.0f) continue;
        held = held + 1u;
        uvec2 pair = pairs[k];
        bool first = firstOwnsContact(pair.x, pair.y);
        uint owner = idOf(idAndMaterial[first ? pair.x : pair.y]);
        uint partner = idOf(idAndMaterial[first ? pair.y : pair.x]);
        uint count = carriedBy(owner);
        if (count == CARRIED_MOST) continue;
        carriedCount[owner] = (counters[COUNTER_LISTS] << 8u) | (count + 1u);
        carried[owner * CARRIED_MOST + count] = uvec2(partner | (first ? FIRST_OWNS : 0u), k);
    }
    if (held > 0u) atomicAdd(counters[COUNTER_CARRIED], held);
}
