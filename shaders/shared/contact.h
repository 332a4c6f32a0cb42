// The geometry of a pair of spheres.

// Spheres touch up to this gap, as a share of the sum of their radii. The push apart leaves pairs within rounding of
// touching.
#define TOUCH_TOLERANCE 1.0e-4f

// A direction for coincident centres. It follows from the ids, so that it is the same in every run.
vec3 directionFromIds(uint a, uint b) {
    uint hash = a * 0x9e3779b1u ^ (b + 0x7f4a7c15u) * 0x85ebca6bu;
    hash ^= hash >> 15u;
    hash *= 0x2c1b3c6du;
    hash ^= hash >> 12u;
    float x = float(hash & 0x3ffu) - 511.5f;
    float y = float((hash >> 10u) & 0x3ffu) - 511.5f;
    float z = float((hash >> 20u) & 0x3ffu) - 511.5f;
    return vec3(x, y, z) * (1.0f / sqrt(x * x + y * y + z * z));
}

// The unit normal from b to a; w: the distance of the centres (m).
vec4 normalAndDistance(vec3 difference, float squared, uint a, uint b) {
    float distance = sqrt(squared);
    if (distance < 1.0e-12f) return vec4(directionFromIds(a, b), 0.0f);
    return vec4(difference * (1.0f / distance), distance);
}

float distanceOf(vec4 normalAndDistance) {
    return normalAndDistance.w;
}
