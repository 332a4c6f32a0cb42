// Third pass of the codec, after the prefix sum over the words of groups, one invocation per group: gives each block
// its offset and the header of the next block. Also writes the frame's head, the table of chunks and the bitmaps of the
// groups.
#include "shared/kernel.h"
#include "shared/codec_layout.h"
PARAMETERS

BUFFER(restrict, uint, scratch)
BUFFER(readonly, uint, groupStart)
BUFFER(writeonly, uint, frame)

KERNEL(params.groups) {
    uint start = groupStart[invocation];
    uint first = invocation * CODEC_GROUP;
    uint end = min(params.blocks, first + CODEC_GROUP);
    uint units = 2u * start + 2u;
    uint bitmap = 0u;
    uint last = 0xffffffffu;
    for (uint block = first; block < end; ++block) {
        uint size = scratch[block * CODEC_SCRATCH + CODEC_SIZE];
        if (size == 0u) continue;
        bitmap = bitmap | (1u << (block - first));
        scratch[block * CODEC_SCRATCH + CODEC_OFFSET] = units;
        units += size;
        uint header = scratch[block * CODEC_SCRATCH + CODEC_HEADER];
        if (last != 0xffffffffu)
            scratch[last] = scratch[last] | (header << 16u);
        last = block * CODEC_SCRATCH + CODEC_HEADER;
    }
    uint chunkStart = params.head + params.chunks;
    frame[chunkStart + start] = bitmap;
    if (invocation % CODEC_CHUNK == CODEC_CHUNK - 1u || invocation == params.groups - 1u)
        frame[params.head + invocation / CODEC_CHUNK] = (units + 1u) / 2u;
    if (invocation != 0u) return;
    frame[0] = CODEC_MAGIC | params.flags;
    frame[1] = params.spheres;
    frame[2] = params.number;
    frame[3] = 0u;
    if (params.head == CODEC_FRAME_HEAD) return;
    frame[4] = params.turns.x;
    frame[5] = params.turns.y;
    frame[6] = params.turns.z;
}
