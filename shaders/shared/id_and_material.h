// What tells spheres apart: a word with the id in the low 24 bits, the material above.

uint idOf(uint word) {
    return word & 0xffffffu;
}

uint materialOf(uint word) {
    return word >> 24u;
}
