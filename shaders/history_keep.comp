// Puts each contact to its owner: the slip as the owner sees it, and the partner's id. Leaves in keptStart where each
// owner's contacts end, which is where those of the next id begin.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/label.h"

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, readonly, uint, label, LabelBlock)
BUFFER(2, readonly, uvec4, span, SpanBlock)
BUFFER(3, readonly, uvec2, pairs, PairBlock)
BUFFER(4, readonly, vec4, history, HistoryBlock)
BUFFER(5, coherent, uint, keptStart, KeptStartBlock)
BUFFER(6, writeonly, vec4, kept, KeptBlock)

#include "shared/owner.h"

KERNEL(params.groups * 8u) {
    uvec4 mine = span[invocation];
    if (mine.y == UNLISTED) return;
    for (uint k = mine.x; k < mine.x + mine.y; ++k) {
        vec4 one = history[k];
        if (one.w == 0.0f) continue;
        uvec2 pair = pairs[k];
        bool first = firstOwns(pair.x, pair.y);
        uint owner = idOf(label[first ? pair.x : pair.y]);
        float other = float(idOf(label[first ? pair.y : pair.x]));  // ids are below 2^24: exact
        vec3 slip = first ? vec3(one) : -vec3(one);
        kept[atomicAdd(keptStart[owner], 1u)] = vec4(slip, other);
    }
}
