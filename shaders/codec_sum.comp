// Second pass of the codec, one invocation per group: counts the words of the group.
#include "shared/kernel.h"
#include "shared/codec_layout.h"
PARAMETERS

BUFFER(readonly, uint, scratch)
BUFFER(writeonly, uint, groupWords)

KERNEL(params.groups) {
    uint end = min(params.blocks, (invocation + 1u) * CODEC_GROUP);
    uint units = 0u;
    for (uint block = invocation * CODEC_GROUP; block < end; ++block)
        units += scratch[block * CODEC_SCRATCH + CODEC_SIZE];
    groupWords[invocation] = 1u + (units + 1u) / 2u;
}
