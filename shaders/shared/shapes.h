// The surfaces of obstacles. The shapes are in shapes/: each has a function that finds the surface of an obstacle of
// this shape nearest to a point.
// A sphere within this share of its radius of a surface touches it, because a push leaves it within rounding of the
// surface.
#define TOUCHES 2.0e-4f

#define SHAPE_FILES
#include "shapes.def"
#undef SHAPE_FILES

// All shapes but planes are curved, boxes at their edges.
bool isCurved(Obstacle obstacle) {
    return obstacle.shape != 0u;
}

// Returns the surface of part `part` of the obstacle as a sphere at `point` (m) meets it. xyz: its normal, of unit
// length, out of the solid. w: the distance of the point from the surface (m), negative in the solid.
ANY_REAL4 surfaceAt(Obstacle obstacle, uint part, ANY_REAL3 point) {
#define SHAPE(flag, Name, text, number, function) \
    if (HAS(flag) && obstacle.shape == number) return function(obstacle, part, point);
#include "shapes.def"
#undef SHAPE
    return row4(point.x, point.y, point.z, abs(point.x) + 1.0e18f);  // no such shape: far away
}
