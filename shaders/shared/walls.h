// Walls, planes and boxes that a sphere touches or overlaps. The includer defines
//   `void visitWall(vec3 normal, float depth, uint wallMaterial, uint surface)`,
// which may move the PRIVATE `wallPoint`. It binds `obstacles`: planes first, then boxes. Surfaces are numbered through
// faces, planes and boxes.
//
// A sphere within this share of its radius of a wall touches it, because the push leaves it within rounding of the
// wall.
#define WALL_TOLERANCE 2.0e-4f

// A plane's row of `obstacles`: w is its offset (m).
float planeOffset(vec4 plane) {
    return plane.w;
}

uint surfaceMaterial(Obstacle obstacle) {
    return uint(obstacle.b.w);
}

void visitFace(uint face, vec3 normal, float depth, float radius) {
    if ((params.closedFaces & (1u << face)) != 0u && depth > -WALL_TOLERANCE * radius)
        visitWall(normal, depth, params.wallMaterial, face);
}

void visitBox(Obstacle box, uint surface, float radius) {
    vec3 low = vec3(box.a);
    vec3 high = vec3(box.b);
    vec3 nearest = vec3(min(max(wallPoint.x, low.x), high.x), min(max(wallPoint.y, low.y), high.y),
                        min(max(wallPoint.z, low.z), high.z));
    vec3 d = wallPoint - nearest;
    float squared = dot3(d, d);
    if (!(squared < radius * radius * (1.0f + 2.0f * WALL_TOLERANCE))) return;
    if (squared > 0.0f) {
        float distance = sqrt(squared);
        visitWall(d * (1.0f / distance), radius - distance, surfaceMaterial(box), surface);
        return;
    }
    // The centre is inside the box: the sphere leaves through the nearest side.
    vec3 toLow = wallPoint - low;
    vec3 toHigh = high - wallPoint;
    float depth = toLow.x;
    vec3 normal = vec3(-1.0f, 0.0f, 0.0f);
    if (toHigh.x < depth) { depth = toHigh.x; normal = vec3(1.0f, 0.0f, 0.0f); }
    if (toLow.y < depth) { depth = toLow.y; normal = vec3(0.0f, -1.0f, 0.0f); }
    if (toHigh.y < depth) { depth = toHigh.y; normal = vec3(0.0f, 1.0f, 0.0f); }
    if (toLow.z < depth) { depth = toLow.z; normal = vec3(0.0f, 0.0f, -1.0f); }
    if (toHigh.z < depth) { depth = toHigh.z; normal = vec3(0.0f, 0.0f, 1.0f); }
    visitWall(normal, depth + radius, surfaceMaterial(box), surface);
}

// Returns true if the sphere is so far inside the bounds that it meets none of their faces, as most spheres are.
bool clearOfFaces(vec3 p, float radius) {
    float r = radius * (1.0f + 2.0f * WALL_TOLERANCE);
    return p.x - r > params.wallMin.x && p.x + r < params.wallMax.x && p.y - r > params.wallMin.y &&
           p.y + r < params.wallMax.y && p.z - r > params.wallMin.z && p.z + r < params.wallMax.z;
}

// Returns true if a quick test shows that the sphere meets no surface.
bool clearOfWalls(vec3 p, float radius) {
    return !HAS(PLANES) && !HAS(BOXES) && clearOfFaces(p, radius);
}

void visitWalls(float radius) {
    if (HAS(WALLS)) {
        visitFace(0u, vec3(1.0f, 0.0f, 0.0f), params.wallMin.x + radius - wallPoint.x, radius);
        visitFace(1u, vec3(-1.0f, 0.0f, 0.0f), wallPoint.x + radius - params.wallMax.x, radius);
        visitFace(2u, vec3(0.0f, 1.0f, 0.0f), params.wallMin.y + radius - wallPoint.y, radius);
        visitFace(3u, vec3(0.0f, -1.0f, 0.0f), wallPoint.y + radius - params.wallMax.y, radius);
        visitFace(4u, vec3(0.0f, 0.0f, 1.0f), params.wallMin.z + radius - wallPoint.z, radius);
        visitFace(5u, vec3(0.0f, 0.0f, -1.0f), wallPoint.z + radius - params.wallMax.z, radius);
    }
    if (HAS(PLANES)) {
        for (uint k = 0u; k < params.planes; ++k) {
            vec4 plane = obstacles[k].a;
            float depth = planeOffset(plane) + radius - dot3(vec3(plane), wallPoint);
            if (depth > -WALL_TOLERANCE * radius) visitWall(vec3(plane), depth, surfaceMaterial(obstacles[k]), 6u + k);
        }
    }
    if (HAS(BOXES)) {
        for (uint k = 0u; k < params.boxes; ++k) visitBox(obstacles[params.planes + k], 6u + params.planes + k, radius);
    }
}
