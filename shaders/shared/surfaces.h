// The surfaces near a sphere: the faces of the bounds, and the obstacles near it. The includer has the PRIVATE variables
// `spherePoint` (m), which visits may move, and `sphereRadius` (m). It defines
//   `void visitSurface(mask where, real3 normal, real separation, real recession, uint wallMaterial, uint surface,
//   uints key)`,
// all that it sees of a surface, in lanes `where`. `normal` points to the sphere. `separation` is the gap between sphere
// and surface (m), negative if they overlap. `recession` is the speed at which a curved surface recedes from the sphere
// while it moves along it (m/s), negative inside a hollow. (They are no struct, because `precise` spreads through its
// members, and glslang would need minutes.) Surfaces are numbered through faces and obstacles in the order of the scene.
// `key` is the number by which a contact is remembered: the surface, or one of the many parts of a mesh.
//
// It also defines `bool looksAhead()`, which returns true in a solver that finds the moment of an impact. There
// `real3 velocityAlong()` is the velocity with which the sphere meets curved surfaces (m/s), elsewhere it is 0.
//
// It binds `obstacles`, `obstacleLists`, `nearObstacles`, `listReference` and `counters`, and has included
// shared/shapes.h, shared/mesh_layout.h and shared/moving.h, whose variables describe the motion of the visited surface.
// It has also included shared/gathered_contacts.h, or has defined its functions gather() and visitGathered().

// The visited surface as a plane: its normal, the separation and the recession.
PRIVATE(real3, planeNormal)
PRIVATE(real, planeSeparation)
PRIVATE(real, planeRecession)

// A loop has one call of visitSurface(). Compilers for GPUs copy its code to each of its calls.
void visitFaces() {
    for (uint face = 0u; face < 6u; ++face) {
        if ((params.closedFaces & (1u << face)) == 0u) continue;
        uint axis = face / 2u;
        real coordinate = axis == 0u ? spherePoint.x : axis == 1u ? spherePoint.y : spherePoint.z;
        real3 normal = real3(axis == 0u ? 1.0f : 0.0f, axis == 1u ? 1.0f : 0.0f, axis == 2u ? 1.0f : 0.0f);
        real separation = real(0.0f);
        if (face % 2u == 0u) {
            float low = axis == 0u ? params.wallMin.x : axis == 1u ? params.wallMin.y : params.wallMin.z;
            // The springs of `accurate` need the difference of the places without rounding.
            separation = HAS(BALANCED) ? coordinate - sphereRadius - low : coordinate - low - sphereRadius;
        } else {
            float high = axis == 0u ? params.wallMax.x : axis == 1u ? params.wallMax.y : params.wallMax.z;
            separation = high - coordinate - sphereRadius;
            normal = -normal;
        }
        visitSurface(true, normal, separation, real(0.0f), params.wallMaterial, face, face);
    }
}

// True for spheres so far inside the bounds that none of the faces is within `reach` (m) of them, as for most spheres.
mask clearOfFaces(real reach) {
    real r = sphereRadius + reach;
    return spherePoint.x - r > params.wallMin.x && spherePoint.x + r < params.wallMax.x &&
           spherePoint.y - r > params.wallMin.y && spherePoint.y + r < params.wallMax.y &&
           spherePoint.z - r > params.wallMin.z && spherePoint.z + r < params.wallMax.z;
}

// Returns the place in `obstacleLists` of the obstacles that may be within `reach` (m) of the sphere in slot `at`, or
// NO_OBSTACLES. Far from where its list was made, a sphere visits all obstacles.
uints obstaclesNear(uintRow at, real reach) {
    if (!HAS(CONTACTS)) return uints(ALL_OBSTACLES);
    real3 since = spherePoint - real3(ROW(listReference, at));
    real moved = sqrt(dot3(since, since)) + reach;
    if (HAS(MOTION)) moved = moved + (uintBitsToFloat(counters[COUNTER_OBSTACLE_PATH]) + params.obstaclePath);
    mask listed = moved < uintBitsToFloat(MEMBER(nearObstacles, at, y));
    return select(listed, MEMBER(nearObstacles, at, x), uints(ALL_OBSTACLES));
}

// Returns a velocity relative to the material of the obstacle, at a share of the substep.
real3 relativeTo(Obstacle obstacle, real share, real3 point, real3 v) {
    if (!isMoving(obstacle)) return v;
    return v - materialVelocity(obstacles[obstacle.motion], share, point);
}

// Returns the surface at a share of the substep.
real4 laterSurfaceAt(Obstacle obstacle, uint part, real share, real3 point) {
    bool moving = isMoving(obstacle);
    real3 place = point;
    if (moving) place = broughtBack(obstacles[obstacle.motion], share, point);
    real4 surface = surfaceAt(obstacle, part, place);
    if (moving) surface = turnedSurface(obstacles[obstacle.motion], share, surface, point);
    return surface;
}

// Sets the plane of a part of an obstacle that is curved or moves, for lanes in `close`, which may meet it in this
// substep. It becomes the plane that touches the part where they meet. Before, it is the surface nearest to the sphere
// now. `relative` is the velocity of the sphere relative to its material (m/s).
void meetCurved(mask close, Obstacle obstacle, uint part, real3 relative) {
    real h = real(params.substep);
    real3 v = velocityAlong();
    real closing = -dot3(relative, planeNormal);
    // `fast` has moved the sphere beyond the meeting, `balanced` has not moved it yet.
    mask meets = close && closing > 0.0f && (HAS(FAST) ? planeSeparation < 0.0f : planeSeparation > 0.0f);
    real earliest = HAS(FAST) ? -h : real(0.0f);
    real latest = HAS(FAST) ? real(0.0f) : h;
    real time = planeSeparation / max(closing, real(1.0e-30f));
    // Two steps to the meeting, and one for the recession at the end of the substep. (In one loop, as in visitFaces().)
    for (uint k = anyLane(meets) ? 0u : 2u; k < (HAS(BALANCED) ? 3u : 2u); ++k) {
        time = k == 2u ? h : min(max(time, earliest), latest);
        real3 along = k == 2u ? v - planeNormal * dot3(relative, planeNormal) : v;
        real3 point = spherePoint + along * time;
        real share = k == 2u ? real(1.0f) : time * params.perSubstep;
        real4 there = laterSurfaceAt(obstacle, part, share, point);
        real3 n = real3(there);
        real speed = dot3(n, relativeTo(obstacle, share, point, along));
        real gap = there.w - sphereRadius;
        if (k == 1u) {
            planeSeparation = select(meets, gap - speed * time, planeSeparation);
            planeNormal = select(meets, n, planeNormal);
        }
        if (k == 2u) planeRecession = select(close, speed * 0.5f, planeRecession);
        time = time - gap / min(speed, real(-1.0e-30f));
    }
}

// Visits a part of an obstacle. `surface` is the surface nearest to the sphere.
void visitPart(mask where, Obstacle obstacle, uint part, real4 surface, bool curved, uint number, uint key) {
    planeNormal = real3(surface);
    planeSeparation = surface.w - sphereRadius;
    planeRecession = real(0.0f);
    real3 v = velocityAlong();
    bool moving = isMoving(obstacle);
    if (moving) {
        real3 point = spherePoint - planeNormal * surface.w;
        setSurfaceMotion(obstacles[obstacle.motion], point, planeNormal);
        if (looksAhead()) v = relativeTo(obstacle, real(0.0f), point, v);
    }
    mask close = where && planeSeparation < sqrt(dot3(v, v)) * params.substep;
    if (looksAhead() && (curved || moving) && anyLane(close)) meetCurved(close, obstacle, part, v);
    visitSurface(where, planeNormal, planeSeparation, planeRecession, obstacle.material, number, key);
    if (moving) setSurfaceAtRest();
}

#include "shared/mesh_surfaces.h"

void visitObstacle(mask where, uint number) {
    Obstacle obstacle = obstacles[number];
    if (HAS(MESHES) && obstacle.shape == MESH_SHAPE) {
        visitMesh(where, obstacle);
        return;
    }
    for (uint part = 0u; part < obstacle.parts; ++part) {
        uint key = obstacle.surface + part;
        visitPart(where, obstacle, part, surfaceAt(obstacle, part, spherePoint), isCurved(obstacle), key, key);
    }
}

// Visits the lists of all lanes together, because spheres beside each other are near the same obstacles.
void visitObstacles(uints from) {
    uints place = from;
    uints number = ROW(obstacleLists, place);
    for (uint least = leastOf(number); least != END_OF_LIST; least = leastOf(number)) {
        mask here = number == least;
        visitObstacle(here, least);
        place = select(here, place + 1u, place);
        number = ROW(obstacleLists, place);
    }
}

// `near`: what obstaclesNear() returned.
void visitSurfaces(uints near) {
    if (HAS(MOTION)) setSurfaceAtRest();
    if (HAS(WALLS)) visitFaces();
    if (HAS(OBSTACLES)) visitObstacles(near);
}
