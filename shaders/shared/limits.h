// How far from the centre of the bounds spheres are followed.

// A sphere beyond this distance (m) stays there for ever: the square of the distance is still finite.
#define LAST_PLACE 1.0e18f

ANY_REAL farthestOf(ANY_REAL3 p) {
    return max(abs(p.x), max(abs(p.y), abs(p.z)));
}
