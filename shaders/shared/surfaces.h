// The surfaces near a sphere, for kernels with lanes. The includer has the PRIVATE variables `spherePoint` (m) and
// `sphereRadius` (m), and defines `void visitSurface(real3 normal, real separation, uint wallMaterial, uint surface)`:
// `separation` is the gap between sphere and surface (m), negative if they overlap. It binds `obstacles`: planes first,
// then boxes. Surfaces are numbered through faces, planes and boxes.

void visitFaces(uint axis, real coordinate, float low, float high, real3 normal) {
    if ((params.closedFaces & (1u << (2u * axis))) != 0u)
        visitSurface(normal, coordinate - sphereRadius - low, params.wallMaterial, 2u * axis);
    if ((params.closedFaces & (2u << (2u * axis))) != 0u)
        visitSurface(-normal, high - coordinate - sphereRadius, params.wallMaterial, 2u * axis + 1u);
}

void visitPlaneSurface(uint k) {
    vec4 plane = obstacles[k].a;
    real3 normal = real3(plane);
    visitSurface(normal, dot3(normal, spherePoint) - plane.w - sphereRadius, uint(obstacles[k].b.w), 6u + k);
}

// A sphere whose centre is inside a box leaves through the nearest side.
void visitBoxSurface(uint k) {
    Obstacle box = obstacles[k];
    real3 low = real3(box.a);
    real3 high = real3(box.b);
    real3 d = spherePoint - real3(min(max(spherePoint.x, low.x), high.x), min(max(spherePoint.y, low.y), high.y),
                                  min(max(spherePoint.z, low.z), high.z));
    real squared = dot3(d, d);
    real distance = sqrt(squared);
    mask inside = !(squared > 0.0f);
    real3 normal = d * (1.0f / max(distance, real(1.0e-30f)));
    real separation = distance - sphereRadius;
    if (anyLane(inside)) {
        real3 toLow = spherePoint - low;
        real3 toHigh = high - spherePoint;
        real depth = toLow.x;
        real3 outward = real3(-1.0f, 0.0f, 0.0f);
        mask nearer = toHigh.x < depth;
        depth = select(nearer, toHigh.x, depth);
        outward = select(nearer, real3(1.0f, 0.0f, 0.0f), outward);
        nearer = toLow.y < depth;
        depth = select(nearer, toLow.y, depth);
        outward = select(nearer, real3(0.0f, -1.0f, 0.0f), outward);
        nearer = toHigh.y < depth;
        depth = select(nearer, toHigh.y, depth);
        outward = select(nearer, real3(0.0f, 1.0f, 0.0f), outward);
        nearer = toLow.z < depth;
        depth = select(nearer, toLow.z, depth);
        outward = select(nearer, real3(0.0f, 0.0f, -1.0f), outward);
        nearer = toHigh.z < depth;
        depth = select(nearer, toHigh.z, depth);
        outward = select(nearer, real3(0.0f, 0.0f, 1.0f), outward);
        normal = select(inside, outward, normal);
        separation = select(inside, -depth - sphereRadius, separation);
    }
    visitSurface(normal, separation, uint(box.b.w), 6u + k);
}

// True for spheres so far inside the bounds that none of the faces is within `reach` (m) of them.
mask clearOfSurfaces(real3 p, real radius, real reach) {
    real r = radius + reach;
    return p.x - r > params.wallMin.x && p.x + r < params.wallMax.x && p.y - r > params.wallMin.y &&
           p.y + r < params.wallMax.y && p.z - r > params.wallMin.z && p.z + r < params.wallMax.z;
}

void visitSurfaces() {
    if (HAS(WALLS)) {
        visitFaces(0u, spherePoint.x, params.wallMin.x, params.wallMax.x, real3(1.0f, 0.0f, 0.0f));
        visitFaces(1u, spherePoint.y, params.wallMin.y, params.wallMax.y, real3(0.0f, 1.0f, 0.0f));
        visitFaces(2u, spherePoint.z, params.wallMin.z, params.wallMax.z, real3(0.0f, 0.0f, 1.0f));
    }
    if (HAS(PLANES))
        for (uint k = 0u; k < params.planes; ++k) visitPlaneSurface(k);
    if (HAS(BOXES))
        for (uint k = params.planes; k < params.planes + params.boxes; ++k) visitBoxSurface(k);
}
