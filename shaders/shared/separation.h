// Distances in bounds that may be periodic along some axes: a sphere that leaves through one face of such an axis comes
// back through the other. Between two rebuilds of the lists, stored positions leave the bounds by less than one length of
// the axis.

// The whole lengths of an axis in the distance d (m), to the nearest. `perLength`: 1 over the length (1/m); 0 for an
// axis that is not periodic, which has none.
ANY_REAL turnsIn(ANY_REAL d, float perLength) {
    return floor(d * perLength + 0.5f);
}

// The vector from b to the nearest image of a (m). Each position gives half of the shift. Both steps are exact for
// spheres near a seam, so that they meet there as they do elsewhere. (glslang needs minutes for some other forms.)
ANY_REAL3 separation(ANY_REAL3 a, ANY_REAL3 b) {
    ANY_REAL3 d = a - b;
    if (!HAS(PERIODIC)) return d;
    precise ANY_REAL3 shift = d;
    shift.x = turnsIn(d.x, params.perLength.x) * params.halfLength.x;
    shift.y = turnsIn(d.y, params.perLength.y) * params.halfLength.y;
    shift.z = turnsIn(d.z, params.perLength.z) * params.halfLength.z;
    precise ANY_REAL3 nearest = (a - shift) - (b + shift);
    return nearest;
}
