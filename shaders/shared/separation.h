// Distances in bounds that may be periodic along some axes: a sphere that leaves through one face of such an axis comes
// back through the other. Between two rebuilds of the lists, stored positions leave the bounds by less than one length of
// the axis.

// The vector from b to the nearest image of a (m). Each position gives half of the shift. Both steps are exact for
// spheres near a seam, so that they meet there as they do elsewhere.
ANY_REAL3 separation(ANY_REAL3 a, ANY_REAL3 b) {
    precise ANY_REAL3 d = a - b;
    if (HAS(PERIODIC)) {
        // Not a function for each axis: glslang would need minutes. An axis that is not periodic has a perLength of 0.
        precise ANY_REAL3 shift = d;
        shift.x = floor(d.x * params.perLength.x + 0.5f) * params.halfLength.x;
        shift.y = floor(d.y * params.perLength.y + 0.5f) * params.halfLength.y;
        shift.z = floor(d.z * params.perLength.z + 0.5f) * params.halfLength.z;
        d = (a - shift) - (b + shift);
    }
    return d;
}
