// Arithmetic of the codec that several kernels share.

// Where sphere k of a block lies in it, on each axis: the eight of a run are eight apart, so that processors with vectors go
// through all runs at once.
uint laneOf(uint k) {
    return (k % 8u) * 8u + k / 8u;
}

// Bits that a width code stands for. Sums of comparisons, because compilers make branches of choices.
uint widthOf(uint code) {
    return min(code, 12u) + 2u * uint(code > 12u) + 4u * uint(code > 13u) + 14u * uint(code > 14u);
}

// The narrowest width code that holds `value`: from the exponent of a float, which processors with vectors have for many
// at once. Whatever has 19 bits or more has the same code.
uint codeFor(uint value) {
    uint bits = max(floatBitsToUint(float(int(min(value, 262144u)))) >> 23u, 126u) - 126u;
    return min(bits, 13u) + uint(bits > 14u) + uint(bits > 18u);
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
