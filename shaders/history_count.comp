// Before the lists are rebuilt: counts the contacts that each sphere keeps for itself and its partners.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/label.h"

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, readonly, uint, label, LabelBlock)
BUFFER(2, readonly, uvec4, span, SpanBlock)
BUFFER(3, readonly, uvec2, pairs, PairBlock)
BUFFER(4, readonly, vec4, history, HistoryBlock)
BUFFER(5, coherent, uint, keptStart, KeptStartBlock)  // by id

#include "shared/owner.h"

KERNEL(params.groups * 8u) {
    uvec4 mine = span[invocation];
    if (mine.y == UNLISTED) return;
    for (uint k = mine.x; k < mine.x + mine.y; ++k) {
        if (history[k].w == 0.0f) continue;
        uvec2 pair = pairs[k];
        atomicAdd(keptStart[idOf(label[firstOwns(pair.x, pair.y) ? pair.x : pair.y])], 1u);
    }
}
