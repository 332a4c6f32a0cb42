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

void visitFaces(uint axis, real coordinate, float low, float high, real3 normal) {
    // The springs of `accurate` need the difference of the places without rounding.
    real aboveLow = HAS(BALANCED) ? coordinate - sphereRadius - low : coordinate - low - sphereRadius;
    if ((params.closedFaces & (1u << (2u * axis))) != 0u)
        visitSurface(true, normal, aboveLow, real(0.0f), params.wallMaterial, 2u * axis, 2u * axis);
    if ((params.closedFaces & (2u << (2u * axis))) != 0u)
        visitSurface(true, -normal, high - coordinate - sphereRadius, real(0.0f), params.wallMaterial, 2u * axis + 1u,
                     2u * axis + 1u);
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
    if (!isMoving(obstacle)) return surfaceAt(obstacle, part, point);
    return movedSurfaceAt(obstacle, obstacles[obstacle.motion], part, share, point);
}

// Visits a part of an obstacle that is curved or moves. Lanes in `close` may meet it in this substep: for them it is the
// plane that touches it where they meet it. `surface` is the surface nearest to the sphere now. `relative` is the velocity
// of the sphere relative to its material (m/s), `number` the number of the surface.
void visitCurved(mask where, mask close, Obstacle obstacle, uint part, real4 surface, real3 relative, uint number,
                 uint key) {
    real h = real(params.substep);
    real3 v = velocityAlong();
    real3 normal = real3(surface);
    real separation = surface.w - sphereRadius;
    real recession = real(0.0f);
    real closing = -dot3(relative, normal);
    // `fast` has moved the sphere beyond the meeting, `balanced` has not moved it yet.
    mask meets = close && closing > 0.0f && (HAS(FAST) ? separation < 0.0f : separation > 0.0f);
    if (anyLane(meets)) {
        real earliest = HAS(FAST) ? -h : real(0.0f);
        real latest = HAS(FAST) ? real(0.0f) : h;
        real time = separation / max(closing, real(1.0e-30f));
        for (uint k = 0u; k < 2u; ++k) {
            time = min(max(time, earliest), latest);
            real3 point = spherePoint + v * time;
            real share = time * params.perSubstep;
            real4 there = laterSurfaceAt(obstacle, part, share, point);
            real3 n = real3(there);
            real gap = there.w - sphereRadius;
            real speed = dot3(relativeTo(obstacle, share, point, v), n);
            if (k == 1u) {
                separation = select(meets, gap - speed * time, separation);
                normal = select(meets, n, normal);
            }
            time = time - gap / min(speed, real(-1.0e-30f));
        }
    }
    if (HAS(BALANCED)) {
        real3 along = v - normal * dot3(relative, normal);
        real3 point = spherePoint + along * h;
        real4 end = laterSurfaceAt(obstacle, part, real(1.0f), point);
        recession = select(close, dot3(real3(end), relativeTo(obstacle, real(1.0f), point, along)) * 0.5f, recession);
    }
    visitSurface(where, normal, separation, recession, obstacle.material, number, key);
}

// Visits a part of an obstacle. `surface` is the surface nearest to the sphere.
void visitPart(mask where, Obstacle obstacle, uint part, real4 surface, bool curved, uint number, uint key) {
    real separation = surface.w - sphereRadius;
    real3 v = velocityAlong();
    bool moving = isMoving(obstacle);
    if (moving) {
        real3 normal = real3(surface);
        real3 point = spherePoint - normal * surface.w;
        setSurfaceMotion(obstacles[obstacle.motion], point, normal);
        if (looksAhead()) v = relativeTo(obstacle, real(0.0f), point, v);
    }
    mask close = where && separation < sqrt(dot3(v, v)) * params.substep;
    if ((curved || moving) && anyLane(close))
        visitCurved(where, close, obstacle, part, surface, v, number, key);
    else
        visitSurface(where, real3(surface), separation, real(0.0f), obstacle.material, number, key);
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
    if (HAS(WALLS)) {
        visitFaces(0u, spherePoint.x, params.wallMin.x, params.wallMax.x, real3(1.0f, 0.0f, 0.0f));
        visitFaces(1u, spherePoint.y, params.wallMin.y, params.wallMax.y, real3(0.0f, 1.0f, 0.0f));
        visitFaces(2u, spherePoint.z, params.wallMin.z, params.wallMax.z, real3(0.0f, 0.0f, 1.0f));
    }
    if (HAS(OBSTACLES)) visitObstacles(near);
}
