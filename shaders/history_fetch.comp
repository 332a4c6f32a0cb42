// After the lists are rebuilt: gives each listed pair what it remembers, found with its owner.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/label.h"

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, readonly, uint, label, LabelBlock)
BUFFER(2, readonly, uvec4, span, SpanBlock)
BUFFER(3, readonly, uvec2, pairs, PairBlock)
BUFFER(4, writeonly, vec4, history, HistoryBlock)
BUFFER(5, readonly, uint, keptStart, KeptStartBlock)
BUFFER(6, readonly, vec4, kept, KeptBlock)

#include "shared/owner.h"

KERNEL(params.groups * 8u) {
    uvec4 mine = span[invocation];
    if (mine.y == UNLISTED) return;
    for (uint k = mine.x; k < mine.x + mine.y; ++k) {
        uvec2 pair = pairs[k];
        bool first = firstOwns(pair.x, pair.y);
        uint owner = idOf(label[first ? pair.x : pair.y]);
        float other = float(idOf(label[first ? pair.y : pair.x]));
        vec4 found = vec4(0.0f, 0.0f, 0.0f, 0.0f);
        for (uint at = owner == 0u ? 0u : keptStart[owner - 1u]; at < keptStart[owner]; ++at)
            if (kept[at].w == other) found = vec4(first ? vec3(kept[at]) : -vec3(kept[at]), 1.0f);
        history[k] = found;
    }
}
