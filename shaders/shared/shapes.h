// The surfaces of obstacles. The shapes are in shapes/: each has a function that finds the surface of an obstacle of
// this shape nearest to a point.
// A sphere within this share of its radius of a surface touches it, because a push leaves it within rounding of the
// surface.
#define TOUCHES 2.0e-4f

// The unit vector from the z axis to a point as x and y, the point's distance from the axis as z, and 0. On the axis:
// any such vector.
ANY_REAL4 acrossAxis(ANY_REAL3 point) {
    precise ANY_REAL squared = point.x * point.x + point.y * point.y;
    ANY_REAL distance = sqrt(squared);
    ANY_REAL inverse = 1.0f / max(distance, 1.0e-30f);
    return row4(select(squared > 0.0f, point.x * inverse, 1.0f), point.y * inverse, distance, min(distance, 0.0f));
}

// A sphere in the tip of a hollow cone, or in a round hole, touches all around. There the place nearest to it changes
// its direction with the slightest motion, and two opposite places do not hold it across. So a surface around an axis
// has more parts than the nearest place, which is part 0. Parts 1 to 4 are the surface in the directions x, y, -x and
// -y from the axis. Near the axis a sphere meets these; on the axis it meets them alone.
#define AROUND_AXIS 5u
#define FAR_AWAY 1.0e18f

float xOfPart(uint part) {
    return part == 1u ? 1.0f : part == 3u ? -1.0f : 0.0f;
}

float yOfPart(uint part) {
    return part == 2u ? 1.0f : part == 4u ? -1.0f : 0.0f;
}

// `distance`: of the point from the surface (m).
ANY_MASK isNearAxis(ANY_REAL fromAxis, ANY_REAL distance) {
    return fromAxis < distance * 0.05f;
}

ANY_MASK isCentred(ANY_REAL fromAxis, ANY_REAL distance) {
    return fromAxis < distance * 1.0e-6f;
}

#define SHAPE_FILES
#include "shapes.def"
#undef SHAPE_FILES

// All shapes but planes are curved, boxes at their edges. (Of meshes, edges and vertices are.)
bool isCurved(Obstacle obstacle) {
    return obstacle.shape != 0u;
}

// Returns the surface of part `part` of the obstacle as a sphere at `point` (m) meets it. xyz: its normal, of unit
// length, out of the solid. w: the distance of the point from the surface (m), negative in the solid. All of it is in
// the coordinates of the obstacle's frame.
ANY_REAL4 shapeAt(Obstacle obstacle, uint part, ANY_REAL3 point) {
#define SHAPE(flag, Name, text, number, function) \
    if (HAS(flag) && obstacle.shape == number) return function(obstacle, part, point);
#include "shapes.def"
#undef SHAPE
    return row4(point.x, point.y, point.z, abs(point.x) + FAR_AWAY);  // no such shape
}

// Returns a point in the coordinates of the obstacle's frame.
ANY_REAL3 intoFrame(Obstacle obstacle, ANY_REAL3 point) {
    ANY_REAL dx = point.x - obstacle.frameX.w;
    ANY_REAL dy = point.y - obstacle.frameY.w;
    ANY_REAL dz = point.z - obstacle.frameZ.w;
    ANY_REAL3 inFrame = point;
    precise ANY_REAL px = dx * obstacle.frameX.x + dy * obstacle.frameX.y + dz * obstacle.frameX.z;
    precise ANY_REAL py = dx * obstacle.frameY.x + dy * obstacle.frameY.y + dz * obstacle.frameY.z;
    precise ANY_REAL pz = dx * obstacle.frameZ.x + dy * obstacle.frameZ.y + dz * obstacle.frameZ.z;
    inFrame.x = px;
    inFrame.y = py;
    inFrame.z = pz;
    return inFrame;
}

// The same as shapeAt() in the coordinates of the bounds.
ANY_REAL4 surfaceAt(Obstacle obstacle, uint part, ANY_REAL3 point) {
    if (!HAS(FRAMES) || obstacle.framed == 0u) return shapeAt(obstacle, part, point);
    ANY_REAL4 surface = shapeAt(obstacle, part, intoFrame(obstacle, point));
    precise ANY_REAL nx = obstacle.frameX.x * surface.x + obstacle.frameY.x * surface.y + obstacle.frameZ.x * surface.z;
    precise ANY_REAL ny = obstacle.frameX.y * surface.x + obstacle.frameY.y * surface.y + obstacle.frameZ.y * surface.z;
    precise ANY_REAL nz = obstacle.frameX.z * surface.x + obstacle.frameY.z * surface.y + obstacle.frameZ.z * surface.z;
    // The axes of the frame are of unit length within rounding. Without a correction, elastic rebounds would gain or
    // lose energy by it.
    precise ANY_REAL squared = nx * nx + ny * ny + nz * nz;
    precise ANY_REAL scale = 1.5f - squared * 0.5f;
    return row4(nx * scale, ny * scale, nz * scale, surface.w);
}
