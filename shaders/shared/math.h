// Written out, because compilers may contract or reorder the built-in one differently on each device.
float dot3(vec3 a, vec3 b) {
    vec3 products = a * b;
    return products.x + products.y + products.z;
}

// From the exponent's bits: compilers take x - x == 0 and its like for granted.
bool finite3(vec3 a) {
    return (floatBitsToUint(a.x) & 0x7f800000u) != 0x7f800000u && (floatBitsToUint(a.y) & 0x7f800000u) != 0x7f800000u &&
           (floatBitsToUint(a.z) & 0x7f800000u) != 0x7f800000u;
}
