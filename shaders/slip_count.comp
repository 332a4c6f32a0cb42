// Before the lists are rebuilt: counts the contacts whose tangential slip each sphere owns.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uvec4, groupRange)
BUFFER(readonly, uvec2, pairs)
BUFFER(readonly, vec4, tangentialSlip)
BUFFER(coherent, uint, carriedOffsets)  // by id

#include "shared/slip_owner.h"

KERNEL(params.groups * 8u) {
    uvec4 range = groupRange[invocation];
    if (!hasList(range)) return;
    for (uint k = firstPair(range); k < firstPair(range) + listedPairs(range); ++k) {
        if (!hasSlip(tangentialSlip[k])) continue;
        uvec2 pair = pairs[k];
        atomicAdd(carriedOffsets[idOf(idAndMaterial[firstKeepsSlip(pair.x, pair.y) ? pair.x : pair.y])], 1u);
    }
}
