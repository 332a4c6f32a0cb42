// Spheres that leave the lists of all spheres to become movers (shared/movers.h). The includer has included
// shared/math.h.

// A sphere leaves the lists of all spheres at this share of the distance at which it asks for new lists (shared/motion.h).
// So the spheres that leave soon become movers together with those that leave now.
#define LEAVES 0.5f
// A sphere is expected to leave from this share on.
#define LEAVES_SOON 0.25f

// How far a sphere may be from its list reference at the end of the substep (m).
float mostMoved(vec3 since, vec3 v) {
    return sqrt(dot3(since, since)) + (sqrt(dot3(v, v)) + params.gravityChange) * params.substep;
}
