// Last pass of the codec, one invocation per block: moves the units from `codec_choose` to their place in the frame. If
// a block begins in the upper half of a word, the block before it writes that half, which is a header.
#include "shared/kernel.h"
#include "shared/codec_layout.h"
PARAMETERS

BUFFER(readonly, uint, blockWords)
BUFFER(readonly, uint, scratch)
BUFFER(writeonly, uint, frame)

KERNEL(params.blocks) {
    uint head = invocation * CODEC_SCRATCH;
    uint size = scratch[head + CODEC_SIZE];
    if (size == 0u) return;
    uint offset = scratch[head + CODEC_OFFSET] + 2u * (params.head + params.chunks);
    uint behind = scratch[head + CODEC_HEADER] & 0xffff0000u;
    int from = int(invocation * CODEC_PACKED);
    int to = int((offset + 1u) / 2u);
    if (offset % 2u == 0u) {
        int whole = int(size / 2u);
        for (int k = 0; k < whole; ++k) frame[to + k] = blockWords[from + k];
        if (size % 2u != 0u) frame[to + whole] = (blockWords[from + whole] & 0xffffu) | behind;
    } else {
        int whole = int((size - 1u) / 2u);
        for (int k = 0; k < whole; ++k)
            frame[to + k] = (blockWords[from + k] >> 16u) | (blockWords[from + k + 1] << 16u);
        if (size % 2u == 0u) frame[to + whole] = (blockWords[from + whole] >> 16u) | behind;
    }
}
