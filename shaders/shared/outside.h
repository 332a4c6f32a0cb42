// Spheres outside the bounds: they have left through an open face. One that is far from all others asks for no new lists,
// however fast it is.
//
// The lists hold in two frames. A sphere inside must stay within params.rebuildMove of its anchor. One outside must stay
// within its share of its room, the gap to the nearest sphere outside that no list pairs it with, of the place where its
// anchor is in a frame that moves: on a ballistic arc, as fast as the fastest sphere outside, so that those that fall
// together hold still in it. Near the bounds, where it may meet spheres inside, both hold.

// What `listReference` holds in w: 0 inside; outside the room, negative where a list pairs the sphere with another one outside.
#define UNLIMITED_ROOM 1.0e18f

// Of its room, what a sphere may use up before there are new lists: two do so at a time, and each looks ahead as far.
#define ROOM_SHARE 0.25f

// In radii. Further out, float32 resolves no thousandth of the radius, and a sphere meets no others.
#define LOST_DISTANCE 8388.608f

// Where a sphere stays for ever, m: its square is still a number.
#define LAST_PLACE 1.0e18f

float beyondFace(uint face, float distance) {
    return (params.closedFaces & (1u << face)) == 0u ? distance : -1.0f;
}

// How far the point is outside, along the axis on which that is most; negative or 0 inside. Nothing is outside a closed face.
float beyond(vec3 p) {
    if (params.closedFaces == 63u) return -1.0f;
    float x = max(beyondFace(0u, params.wallMin.x - p.x), beyondFace(1u, p.x - params.wallMax.x));
    float y = max(beyondFace(2u, params.wallMin.y - p.y), beyondFace(3u, p.y - params.wallMax.y));
    float z = max(beyondFace(4u, params.wallMin.z - p.z), beyondFace(5u, p.z - params.wallMax.z));
    return max(x, max(y, z));
}

// As wide as a cell of the coarsest level, the strip around the bounds in which a sphere may touch one inside.
float strip() {
    return 1.0f / params.inverseCell;
}

bool beyondStrip(vec3 p) {
    return beyond(p) > strip();
}

float farthestAxis(vec3 p) {
    return max(abs(p.x), max(abs(p.y), abs(p.z)));
}

bool lost(vec4 sphere) {
    return farthestAxis(vec3(sphere)) > LOST_DISTANCE * (HAS(RADII) ? sphere.w : params.radius);
}
