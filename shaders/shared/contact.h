// The geometry of a pair of spheres.

// Spheres touch up to this gap, as a share of the sum of their radii. The push apart leaves pairs within rounding of
// touching.
#define TOUCH_TOLERANCE 1.0e-4f

// A direction for coincident centres. It follows from the slots, so that it is the same in every run.
RARE real3 directionFromSlots(slots a, slots b) {
    uints hash = uints(a) * 0x9e3779b1u ^ (uints(b) + 0x7f4a7c15u) * 0x85ebca6bu;
    hash = hash ^ (hash >> 15u);
    hash = hash * 0x2c1b3c6du;
    hash = hash ^ (hash >> 12u);
    real x = real(hash & 0x3ffu) - 511.5f;
    real y = real((hash >> 10u) & 0x3ffu) - 511.5f;
    real z = real((hash >> 20u) & 0x3ffu) - 511.5f;
    return real3(x, y, z) * (1.0f / sqrt(x * x + y * y + z * z));
}

// The unit normal from b to a; w: the distance of the centres (m).
real4 normalAndDistance(real3 difference, real squared, slots a, slots b) {
    real distance = sqrt(squared);
    mask coincident = distance < 1.0e-12f;
    real3 n = difference * (1.0f / max(distance, real(1.0e-12f)));
    if (!anyLane(coincident)) return real4(n, distance);
    return real4(select(coincident, directionFromSlots(a, b), n), select(coincident, real(0.0f), distance));
}

real distanceOf(real4 normalAndDistance) {
    return normalAndDistance.w;
}
