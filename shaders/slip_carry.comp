// Copies each contact to its owner's part of `carriedSlip`: the slip as the owner sees it, and the id of the partner.
// Advances the owner's offset in `carriedOffsets` to the end of its contacts, where the contacts of the next id begin.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uvec4, groupRange)
BUFFER(readonly, uvec2, pairs)
BUFFER(readonly, vec4, tangentialSlip)
BUFFER(coherent, uint, carriedOffsets)
BUFFER(writeonly, vec4, carriedSlip)

#include "shared/slip_owner.h"

KERNEL(params.groups * 8u) {
    uvec4 range = groupRange[invocation];
    if (!hasList(range)) return;
    for (uint k = firstPair(range); k < firstPair(range) + listedPairs(range); ++k) {
        vec4 stored = tangentialSlip[k];
        if (!hasSlip(stored)) continue;
        uvec2 pair = pairs[k];
        bool first = firstKeepsSlip(pair.x, pair.y);
        uint owner = idOf(idAndMaterial[first ? pair.x : pair.y]);
        float partner = float(idOf(idAndMaterial[first ? pair.y : pair.x]));  // ids are below 2^24: exact
        vec3 slip = first ? vec3(stored) : -vec3(stored);
        carriedSlip[atomicAdd(carriedOffsets[owner], 1u)] = vec4(slip, partner);
    }
}
