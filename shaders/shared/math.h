// Dot and cross products are written out, because compilers may contract or reorder the built-in ones differently on
// each device.
ANY_REAL dot3(ANY_REAL3 a, ANY_REAL3 b) {
    precise ANY_REAL3 products = a * b;
    precise ANY_REAL total = products.x + products.y + products.z;
    return total;
}

ANY_REAL3 cross3(ANY_REAL3 a, ANY_REAL3 b) {
    precise ANY_REAL3 product = a;
    product.x = a.y * b.z - a.z * b.y;
    product.y = a.z * b.x - a.x * b.z;
    product.z = a.x * b.y - a.y * b.x;
    return product;
}

// Returns true if all components are finite. Tests the bits of the exponent, because compilers assume that tests such
// as x - x == 0 are always true.
bool finite3(vec3 a) {
    return (floatBitsToUint(a.x) & 0x7f800000u) != 0x7f800000u && (floatBitsToUint(a.y) & 0x7f800000u) != 0x7f800000u &&
           (floatBitsToUint(a.z) & 0x7f800000u) != 0x7f800000u;
}
