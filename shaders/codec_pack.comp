// The codec, last pass, one invocation per block: packs what `codec_choose` left into the words of the frame. Where a block
// begins in the upper half of a word, the block before it writes that half: it holds a header.
#include "shared/kernel.h"
#include "shared/codec_layout.h"
#include "shared/codec.h"
PARAMETERS

BUFFER(0, readonly, uint, values, ValueBlock)
BUFFER(1, readonly, uint, scratch, ScratchBlock)
BUFFER(2, writeonly, uint, frame, FrameBlock)

PRIVATE(uint, word)  // not full yet
PRIVATE(uint, fill)  // bits in it, below 32
PRIVATE(uint, at)    // where it goes
PRIVATE(uint, changed[CODEC_RUNS])  // bit per value of a run

// `value` has at most `bits` bits, of 32.
void put(uint value, uint bits) {
    word = word | (value << fill);
    fill = fill + bits;
    if (fill >= 32u) {
        frame[at] = word;
        at = at + 1u;
        fill = fill - 32u;
        word = fill == 0u ? 0u : value >> (bits - fill);
    }
}

// A run's values are eight apart.
void putRun(uint first, uint width) {
    if (width == 0u) return;
    if (width <= 8u) {
        for (uint k = first; k < first + 64u; k += 32u)
            put(values[k] | (values[k + 8u] << width) | (values[k + 16u] << (2u * width)) | (values[k + 24u] << (3u * width)),
                4u * width);
    } else if (width <= 16u) {
        for (uint k = first; k < first + 64u; k += 16u) put(values[k] | (values[k + 8u] << width), 2u * width);
    } else {
        for (uint k = first; k < first + 64u; k += 8u) put(values[k], width);
    }
}

// The values that are not 0, and before them which these are.
void putChanged(uint first, uint header) {
    for (uint axis = 0u; axis < 3u; ++axis) {
        uint there = 0u;
        for (uint run = 0u; run < 8u; ++run) {
            uint bits = 0u;
            for (uint k = 0u; k < CODEC_RUN; ++k)
                bits = bits | (values[first + axis * 64u + 8u * k + run] != 0u ? 1u << k : 0u);
            changed[8u * axis + run] = bits;
            there = there | (bits != 0u ? 1u << run : 0u);
        }
        put(there, 8u);
    }
    for (uint run = 0u; run < CODEC_RUNS; ++run)
        if (changed[run] != 0u) put(changed[run], 8u);
    for (uint run = 0u; run < CODEC_RUNS; ++run) {
        uint width = widthOf((header >> (4u + run / 8u * 4u)) & 15u);
        uint from = first + run / 8u * 64u + run % 8u;
        for (uint rest = changed[run]; rest != 0u; rest = rest & (rest - 1u))
            put(values[from + 8u * uint(findLSB(rest))] - 1u, width);
    }
}

KERNEL(params.blocks) {
    uint head = invocation * CODEC_SCRATCH;
    if (scratch[head + CODEC_SIZE] == 0u) return;
    uint header = scratch[head + CODEC_HEADER];
    uint mode = header & 3u;
    uint offset = scratch[head + CODEC_OFFSET] + 2u * (CODEC_FRAME_HEAD + params.chunks);
    word = 0u;
    fill = 0u;
    at = (offset + 1u) / 2u;
    if (offset % 2u == 0u) put(header & 0xffffu, 16u);
    uint extra = extraUnits(mode, (header >> 2u) & 3u);
    for (uint unit = 0u; unit < extra; ++unit)
        put((scratch[head + CODEC_EXTRA + unit / 2u] >> (16u * (unit % 2u))) & 0xffffu, 16u);
    uint low = scratch[head + CODEC_EXTRA];
    uint high = scratch[head + CODEC_EXTRA + 1u];
    for (uint axis = 0u; axis < 3u; ++axis) {
        uint first = invocation * CODEC_VALUES + axis * 64u;
        uint code = (header >> (4u + 4u * axis)) & 15u;
        uint selectors = mode < CODEC_SELECT ? 0u : (axis == 2u ? high : low >> (16u * axis));
        for (uint run = 0u; run < 8u && mode != CODEC_MASK; ++run)
            putRun(first + run, widthOf(code - min(code, (selectors >> (2u * run)) & 3u)));
    }
    if (mode == CODEC_MASK) putChanged(invocation * CODEC_VALUES, header);
    if (fill > 16u) frame[at] = word;
    else if (fill > 0u) frame[at] = word | (header & 0xffff0000u);
}
