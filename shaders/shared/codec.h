// Arithmetic of the codec that several kernels share.

// Where sphere k of a block lies in it, on each axis: the eight of a run are eight apart, so that processors with vectors go
// through all runs at once.
uint laneOf(uint k) {
    return (k % 8u) * 8u + k / 8u;
}

// Width codes and widths differ from how many bits there are only above 12: by what stands in the digits of a constant,
// because compilers make branches, or much longer code, of choices.

// Bits that a width code stands for.
uint widthOf(uint code) {
    return code + ((0x11040100u >> (8u * max(code, 12u) - 96u)) & 255u);
}

// The bits of `value`, or 19 where it has more: from the exponent of a float, which processors with vectors have for many at
// once.
uint bitsOf(uint value) {
    return max(floatBitsToUint(float(int(min(value, 262144u)))) >> 23u, 126u) - 126u;
}

// The narrowest width code that holds `value`.
uint codeFor(uint value) {
    uint bits = bitsOf(value);
    return bits - ((0x44321100u >> (4u * max(bits, 12u) - 48u)) & 15u);
}

// widthOf(codeFor(value)), for less.
uint widthFor(uint value) {
    uint bits = bitsOf(value);
    return bits + ((0xd0123010u >> (4u * max(bits, 12u) - 48u)) & 15u);
}

// The narrowest that a run may have, where the code of its axis is `widest`.
uint leastCode(uint widest) {
    return max(widest, 3u) - 3u;
}

uint zigzag(uint value) {
    return (value << 1u) ^ uint(int(value) >> 31);
}

// Of selectors and base, which stand between the header and the values of a block.
uint extraUnits(uint mode, uint predictor) {
    if (mode == CODEC_PLAIN || mode == CODEC_MASK) return 0u;
    if (mode == CODEC_SELECT) return 3u;
    return predictor == CODEC_NONE ? 9u : 5u;
}
