// Packs positions for the wire, 64 spheres per invocation in id order: three 16-bit cells of the wire grid per sphere.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, readonly, uint, slotOf, SlotBlock)
BUFFER(2, writeonly, uint, wire, WireBlock)

uint quantise(float x, float origin) {
    // Not finite or beyond the grid: its edge.
    float q = floor((x - origin) * params.wireOrigin.w + 0.5f);
    return q > 0.0f ? uint(min(q, 65535.0f)) : 0u;
}

KERNEL((params.spheres + 63u) / 64u) {
    uint word = invocation * 96u;
    for (uint k = invocation * 64u; k < invocation * 64u + 64u; k += 2u) {
        uint first = min(k, params.spheres - 1u);
        uint second = min(k + 1u, params.spheres - 1u);
        vec4 a = position[HAS(CONTACTS) ? slotOf[first] : first];
        vec4 b = position[HAS(CONTACTS) ? slotOf[second] : second];
        wire[word] = quantise(a.x, params.wireOrigin.x) | (quantise(a.y, params.wireOrigin.y) << 16u);
        wire[word + 1u] = quantise(a.z, params.wireOrigin.z) | (quantise(b.x, params.wireOrigin.x) << 16u);
        wire[word + 2u] = quantise(b.y, params.wireOrigin.y) | (quantise(b.z, params.wireOrigin.z) << 16u);
        word = word + 3u;
    }
}
