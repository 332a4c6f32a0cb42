// Arithmetic of the codec that several kernels share.

// The place of sphere k within a block, on each axis. The eight spheres of a run are eight places apart, so that
// processors with vector units handle all runs at once.
uint laneOf(uint k) {
    return (k % 8u) * 8u + k / 8u;
}

// A width code, its width and the number of bits are equal up to 12. Above 12, the digits of a constant hold the
// differences, because compilers turn choices into branches or much longer code.

// The number of bits that a width code stands for.
uint widthOf(uint code) {
    return code + ((0x11040100u >> (8u * max(code, 12u) - 96u)) & 255u);
}

// The number of bits of `value`, at most 19. It is read from the exponent of a float, because vector units convert many
// values at once.
uint bitsOf(uint value) {
    return max(floatBitsToUint(float(int(min(value, 262144u)))) >> 23u, 126u) - 126u;
}

// The narrowest width code that holds `value`.
uint codeFor(uint value) {
    uint bits = bitsOf(value);
    return bits - ((0x44321100u >> (4u * max(bits, 12u) - 48u)) & 15u);
}

// Equal to widthOf(codeFor(value)), but cheaper.
uint widthFor(uint value) {
    uint bits = bitsOf(value);
    return bits + ((0xd0123010u >> (4u * max(bits, 12u) - 48u)) & 15u);
}

// The narrowest code that a run may have if the code of its axis is `widest`.
uint leastCode(uint widest) {
    return max(widest, 3u) - 3u;
}

uint zigzag(uint value) {
    return (value << 1u) ^ uint(int(value) >> 31);
}

// Units of the selectors and the base, which stand between the header and the values of a block.
uint extraUnits(uint mode, uint predictor) {
    if (mode == CODEC_PLAIN || mode == CODEC_MASK) return 0u;
    if (mode == CODEC_SELECT) return 3u;
    return predictor == CODEC_NONE ? 9u : 5u;
}
