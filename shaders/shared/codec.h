// Arithmetic of the codec that several kernels share.

// Bits that a width code stands for.
uint widthOf(uint code) {
    return code < 13u ? code : (code == 13u ? 14u : (code == 14u ? 18u : 32u));
}

// The narrowest width code that holds `value`.
uint codeFor(uint value) {
    uint bits = uint(findMSB(value) + 1);
    return bits < 13u ? bits : (bits < 15u ? 13u : (bits < 19u ? 14u : 15u));
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
