// Written out, because compilers may contract or reorder the built-in ones differently on each device.
float dot3(vec3 a, vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// From the exponent's bits: compilers take x - x == 0 and its like for granted.
bool finite3(vec3 a) {
    return (floatBitsToUint(a.x) & 0x7f800000u) != 0x7f800000u && (floatBitsToUint(a.y) & 0x7f800000u) != 0x7f800000u &&
           (floatBitsToUint(a.z) & 0x7f800000u) != 0x7f800000u;
}
