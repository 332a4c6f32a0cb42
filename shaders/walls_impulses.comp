// Walls and obstacles in the model `fast`: applies the impulse of restitution and friction at the moment of impact. The
// speed at that moment follows from the depth: sqrt(v^2 - 2 a depth). The sphere flies on from the wall along its new
// arc. A sphere that would fall back within the substep is moved out of the wall instead, and neither gains nor loses
// height.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/fields.h"
#include "shared/friction.h"
#include "shared/shapes.h"
#include "shared/moving.h"

BUFFER(restrict, vec4, position)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(readonly, uint, obstacleLists)
BUFFER(readonly, uvec2, nearObstacles)
BUFFER(readonly, vec4, listReference)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(coherent, uint, counters)
BUFFER(coherent, uint, surfaceSums)
BUFFER(restrict, float, wallWork)  // by id: work of pushes out of walls against gravity and fields (J)

PRIVATE(uint, sphereSlot)
PRIVATE(float, sphereRadius)
PRIVATE(vec3, spherePoint)
PRIVATE(vec3, solvedVelocity)  // m/s
PRIVATE(vec3, omega)           // rad/s
PRIVATE(vec3, pushedOut)       // m, the moves out of walls that are no flight
PRIVATE(bool, touched)
PRIVATE(float, sphereInverseMass)  // 1/kg

#include "shared/contact_params.h"
#include "shared/friction_wall.h"
#include "shared/surface_sums.h"

// The speed at the moment of impact (m/s, positive). `speed` is the normal speed at the end of the substep (m/s,
// negative). `pull` is the acceleration along the normal (m/s^2). `depth` is the depth of the sphere in the wall (m).
// It is a function of its own, so that `precise` applies to nothing else.
float impactSpeed(float speed, float pull, float depth) {
    precise float impact = sqrt(max(speed * speed + 2.0f * pull * depth, 0.0f));
    return impact;
}

// The normal speed at the end of the substep after a rebound at `rebound` (m/s), `since` seconds before.
float speedAfter(float rebound, float pull, float since) {
    precise float after = rebound + pull * since;
    return after;
}

// Adds the changes of velocity (m/s) and spin (rad/s) by a surface to its sums.
void addChanges(uint surface, vec3 velocityBefore, vec3 spinBefore) {
    precise float mass = 1.0f / sphereInverseMass;
    precise float inertia = 0.4f * mass * sphereRadius * sphereRadius;
    precise vec3 impulse = (solvedVelocity - velocityBefore) * mass;
    precise vec3 moment = cross3(spherePoint, impulse);
    if (HAS(FRICTION)) moment = moment + (omega - spinBefore) * inertia;
    addToSurfaceSums(sphereSlot, surface, impulse, moment);
}

vec3 pullOnSphere() {
    return accelerationAt(spherePoint, sphereRadius, sphereInverseMass);
}

bool looksAhead() {
    return true;
}

vec3 velocityAlong() {
    return solvedVelocity;
}

void visitSurface(bool where, vec3 normal, float separation, float recession, uint wallMaterial, uint surface,
                  uint key) {
    if (!(separation < TOUCHES * sphereRadius)) return;
    touched = true;
    vec4 contact = contactParams[wallContactIndex(sphereSlot, wallMaterial)].contact;
    float push = max(-separation, 0.0f);
    float speed = dot3(relativeVelocity(), normal);
    if (HAS(MOTION)) {
        float motion = -speed * params.substep;
        RAISE_TO(motion > sphereRadius * SAFE_MOTION, counters[COUNTER_LARGEST_MOTION], motion / sphereRadius)
    }
    if (speed >= 0.0f) {
        spherePoint = spherePoint + normal * push;
        pushedOut = pushedOut + normal * push;
        return;
    }
    float pull = HAS(GRAVITY) || HAS(FIELDS) ? dot3(pullOnSphere(), normal) : 0.0f;
    float impact = impactSpeed(speed, pull, push);
    float rebound = restitutionOf(contact) * impact;
    float since = 2.0f * push / (impact - speed);
    float after = speedAfter(rebound, pull, since);
    bool flies = after > 0.0f;
    float speedChange = (flies ? after : rebound) - speed;
    vec3 velocityBefore = solvedVelocity;
    vec3 spinBefore = omega;
    solvedVelocity = solvedVelocity + normal * speedChange;
    vec3 bounced = solvedVelocity;
    if (HAS(FRICTION)) applyWallFriction(normal, sphereRadius, speedChange, contact);
    if (HAS(CONTACT_SUMS)) addChanges(surface, velocityBefore, spinBefore);
    spherePoint = spherePoint + normal * push;
    if (flies)
        spherePoint = spherePoint + normal * (0.5f * (rebound + after) * since) + (solvedVelocity - bounced) * since;
    else
        pushedOut = pushedOut + normal * push;
}

#include "shared/mesh_layout.h"
// Only `accurate` gathers contacts.
void gather(vec4 surface, Obstacle mesh, uint key) {}
void visitGathered(Obstacle mesh) {}

#include "shared/surfaces.h"

KERNEL(params.spheres) {
    vec4 x = position[invocation];
    sphereSlot = invocation;
    sphereRadius = radiusOf(x);
    spherePoint = vec3(x);
    float reach = TOUCHES * sphereRadius;
    uint near = HAS(OBSTACLES) ? obstaclesNear(invocation, reach) : NO_OBSTACLES;
    if (near == NO_OBSTACLES && clearOfFaces(reach)) return;
    vec4 v = velocity[invocation];
    if ((HAS(SLEEP) || HAS(FIXED)) && !isAwake(v)) return;
    sphereInverseMass = inverseMassOf(v);
    solvedVelocity = vec3(v);
    pushedOut = vec3(0.0f, 0.0f, 0.0f);
    touched = false;
    omega = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(FRICTION)) omega = vec3(angularVelocity[invocation]);
    visitSurfaces(near);
    if (!touched) return;
    position[invocation] = withXyz(x, spherePoint);
    velocity[invocation] = withXyz(v, solvedVelocity);
    if (HAS(FRICTION)) angularVelocity[invocation] = vec4(omega, 0.0f);
    if (HAS(GRAVITY) || HAS(FIELDS)) {
        uint id = idOf(idAndMaterial[invocation]);
        wallWork[id] = wallWork[id] - dot3(pullOnSphere(), pushedOut) / sphereInverseMass;
    }
}
