// The own acceleration of spheres: two words for each (shared/layout.h). Components lose their lowest bits, so that the
// mean of a constant does not exceed it.

ANY_REAL3 ownAcceleration(ANY_UINT xz, ANY_UINT yz) {
    return real3(uintBitsToFloat(ACCELERATION_X_BITS(xz, yz)), uintBitsToFloat(ACCELERATION_Y_BITS(xz, yz)),
                 uintBitsToFloat(ACCELERATION_Z_BITS(xz, yz)));
}

ANY_UINT accelerationXzOf(ANY_REAL3 a) {
    return (floatBitsToUint(a.x) & ACCELERATION_BITS) | (floatBitsToUint(a.z) >> 21u);
}

ANY_UINT accelerationYzOf(ANY_REAL3 a) {
    return (floatBitsToUint(a.y) & ACCELERATION_BITS) | ((floatBitsToUint(a.z) >> 11u) & 0x3ffu);
}
