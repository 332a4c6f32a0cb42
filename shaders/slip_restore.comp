// After the lists are rebuilt: copies the tangential slip of each listed pair back from its owner.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uvec4, groupRange)
BUFFER(readonly, uvec2, pairs)
BUFFER(writeonly, vec4, tangentialSlip)
BUFFER(readonly, uint, carriedOffsets)
BUFFER(readonly, vec4, carriedSlip)

#include "shared/slip_owner.h"

KERNEL(params.groups * 8u) {
    uvec4 range = groupRange[invocation];
    if (!hasList(range)) return;
    for (uint k = firstPair(range); k < firstPair(range) + listedPairs(range); ++k) {
        uvec2 pair = pairs[k];
        bool first = firstKeepsSlip(pair.x, pair.y);
        uint owner = idOf(idAndMaterial[first ? pair.x : pair.y]);
        float partner = float(idOf(idAndMaterial[first ? pair.y : pair.x]));
        vec4 found = vec4(0.0f, 0.0f, 0.0f, 0.0f);
        for (uint at = owner == 0u ? 0u : carriedOffsets[owner - 1u]; at < carriedOffsets[owner]; ++at)
            if (partnerOf(carriedSlip[at]) == partner)
                found = vec4(first ? vec3(carriedSlip[at]) : -vec3(carriedSlip[at]), 1.0f);
        tangentialSlip[k] = found;
    }
}
