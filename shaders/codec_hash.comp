// Adds the hash of the newest state to word 3 of the frame, one invocation per block.
#include "shared/kernel.h"
#include "shared/codec_layout.h"
#include "shared/codec.h"
PARAMETERS

BUFFER(readonly, uint, newest)
BUFFER(coherent, uint, frame)

KERNEL(params.blocks) {
    uint first = invocation * CODEC_VALUES;
    uint sum = 0u;
    for (uint k = 0u; k < CODEC_BLOCK; ++k) {
        uint sphere = invocation * CODEC_BLOCK + k;
        uint at = first + laneOf(k);
        uint h = (newest[at] + sphere * 0x9e3779b1u) * 0x85ebca77u;
        h = h ^ (h >> 15u);
        h = (h + newest[at + 64u]) * 0xc2b2ae3du;
        h = h ^ (h >> 13u);
        h = (h + newest[at + 128u]) * 0x27d4eb2fu;
        h = h ^ (h >> 16u);
        sum += sphere < params.spheres ? h : 0u;
    }
    atomicAdd(frame[3], sum);
}
