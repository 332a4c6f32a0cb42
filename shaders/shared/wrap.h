// Places in bounds that may be periodic along some axes. The includer has included shared/separation.h.

// The whole lengths by which a coordinate p (m) lies outside the bounds; 0 inside.
float turnsOutside(float p, float halfLength, float perLength) {
    return p >= -halfLength && p < halfLength ? 0.0f : turnsIn(p, perLength);
}

// The same for each axis.
vec3 turnsOf(vec3 p) {
    return vec3(turnsOutside(p.x, params.halfLength.x, params.perLength.x),
                turnsOutside(p.y, params.halfLength.y, params.perLength.y),
                turnsOutside(p.z, params.halfLength.z, params.perLength.z));
}

// The image of a point (m) that is inside the bounds along the periodic axes: `turns` is turnsOf(p). Exact for points
// that are outside by less than one length.
vec3 movedBack(vec3 p, vec3 turns) {
    precise vec3 way = turns * (vec3(params.halfLength) * 2.0f);
    precise vec3 image = p - way;
    return image;
}

vec3 wrapped(vec3 p) {
    if (!HAS(PERIODIC)) return p;
    return movedBack(p, turnsOf(p));
}

// True if a point is so far outside the bounds that it must be moved back soon, before it is outside by one length.
ANY_MASK mustWrap(ANY_REAL3 p) {
    return abs(p.x) * params.perLength.x > 0.75f || abs(p.y) * params.perLength.y > 0.75f ||
           abs(p.z) * params.perLength.z > 0.75f;
}
