// A word per sphere: the id in the low 24 bits, the material above them.

uint idOf(uint word) {
    return word & 0xffffffu;
}

uint materialOf(uint word) {
    return word >> 24u;
}
