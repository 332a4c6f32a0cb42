// The includer has included shared/limits.h.
//
// Spheres outside the bounds have left through an open face. A sphere that is far from all others asks for no new
// lists, however fast it is.
//
// The lists hold in two frames of reference. A sphere inside must stay within params.rebuildMove of its list reference. A
// mover inside may move farther (shared/mover_reach.h).
//
// A sphere outside must stay close to its list reference in a frame that moves. The frame follows a ballistic arc, as
// fast as the fastest sphere outside, so that spheres that fall together rest in it. The allowed distance is a share of
// the sphere's room. The room is the gap to the nearest sphere outside that no list pairs with it. Near the bounds,
// where the sphere may meet spheres inside, both conditions hold.

// listReference.w is 0 for a sphere inside. For a sphere outside it is its room (m), negative if a list pairs it with
// another one outside. This value means that there is no limit.
#define UNLIMITED_ROOM 1.0e18f

// For a mover inside, listReference.w is the additional distance that it may move (shared/mover_reach.h), in units of
// 2^-100 m. Values from this one on are such distances.
#define LEAST_MORE_MOTION 1.0e19f
#define MORE_MOTION_UNITS 1.2676506e30f  // 2^100

ANY_MASK isRoom(ANY_REAL w) {
    return w < LEAST_MORE_MOTION;
}

float roomOf(vec4 reference) {
    return isRoom(reference.w) ? reference.w : 0.0f;
}

// Returns the distance (m) that the sphere may move in addition to params.rebuildMove before its lists are rebuilt.
// `w`: of its row of listReference.
ANY_REAL moreMotionOf(ANY_REAL w) {
    return select(isRoom(w), w * 0.0f, w * (1.0f / MORE_MOTION_UNITS));
}

// The share of its room that a sphere may use up before there are new lists. Two spheres use up the same gap, and each
// looks ahead as far.
#define ROOM_SHARE 0.25f

// A sphere farther out than this, in radii, is lost: float32 does not resolve a thousandth of its radius, and it meets
// no other sphere.
#define LOST_DISTANCE 8388.608f

float beyondFace(uint face, float distance) {
    return (params.openFaces & (1u << face)) != 0u ? distance : -1.0f;
}

// The distance of the point outside the bounds (m), along the axis on which it is largest. It is negative or 0 inside.
// No point is outside a closed face, or outside along a periodic axis.
float beyond(vec3 p) {
    if (params.openFaces == 0u) return -1.0f;
    float x = max(beyondFace(0u, params.wallMin.x - p.x), beyondFace(1u, p.x - params.wallMax.x));
    float y = max(beyondFace(2u, params.wallMin.y - p.y), beyondFace(3u, p.y - params.wallMax.y));
    float z = max(beyondFace(4u, params.wallMin.z - p.z), beyondFace(5u, p.z - params.wallMax.z));
    return max(x, max(y, z));
}

// The width (m) of the strip around the bounds in which a sphere may touch one inside: a cell of the coarsest level. A
// mover goes out farther before it has new lists.
float strip() {
    return 1.0f / (HAS(MOVERS) ? params.levelSize[params.moverLevel].x : params.inverseCell);
}

mask leavesBounds(real3 p) {
    return p.x < params.wallMin.x || p.x > params.wallMax.x || p.y < params.wallMin.y || p.y > params.wallMax.y ||
           p.z < params.wallMin.z || p.z > params.wallMax.z;
}

bool beyondStrip(vec3 p) {
    return beyond(p) > strip();
}

ANY_MASK lost(ANY_REAL4 sphere) {
    return max(abs(sphere.x), max(abs(sphere.y), abs(sphere.z))) > LOST_DISTANCE * radiusOf(sphere);
}
