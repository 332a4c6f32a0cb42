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

BUFFER(restrict, vec4, position)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(restrict, float, wallWork)  // by id: work of pushes out of walls against gravity and fields (J)

PRIVATE(uint, wallSphere)
PRIVATE(float, wallRadius)
PRIVATE(vec3, wallPoint)
PRIVATE(vec3, solvedVelocity)  // m/s
PRIVATE(vec3, omega)           // rad/s
PRIVATE(vec3, pushedOut)       // m, the moves out of walls that are no flight
PRIVATE(bool, touched)

#include "shared/contact_params.h"
#include "shared/friction_wall.h"

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

void visitWall(vec3 normal, float depth, uint wallMaterial, uint surface) {
    touched = true;
    vec4 contact = contactParams[wallContactIndex(wallSphere, wallMaterial)].contact;
    float push = max(depth, 0.0f);
    float speed = dot3(solvedVelocity, normal);
    if (speed >= 0.0f) {
        wallPoint = wallPoint + normal * push;
        pushedOut = pushedOut + normal * push;
        return;
    }
    float pull = HAS(GRAVITY) || HAS(FIELDS) ? dot3(accelerationAt(wallPoint), normal) : 0.0f;
    float impact = impactSpeed(speed, pull, push);
    float rebound = restitutionOf(contact) * impact;
    float since = 2.0f * push / (impact - speed);
    float after = speedAfter(rebound, pull, since);
    bool flies = after > 0.0f;
    float speedChange = (flies ? after : rebound) - speed;
    solvedVelocity = solvedVelocity + normal * speedChange;
    vec3 bounced = solvedVelocity;
    if (HAS(FRICTION)) applyWallFriction(normal, wallRadius, speedChange, contact);
    wallPoint = wallPoint + normal * push;
    if (flies)
        wallPoint = wallPoint + normal * (0.5f * (rebound + after) * since) + (solvedVelocity - bounced) * since;
    else
        pushedOut = pushedOut + normal * push;
}

#include "shared/walls.h"

KERNEL(params.spheres) {
    vec4 x = position[invocation];
    wallSphere = invocation;
    wallRadius = radiusOf(x);
    wallPoint = vec3(x);
    if (clearOfWalls(wallPoint, wallRadius)) return;
    vec4 v = velocity[invocation];
    if (HAS(SLEEP) && isAsleep(v)) return;
    solvedVelocity = vec3(v);
    pushedOut = vec3(0.0f, 0.0f, 0.0f);
    touched = false;
    if (HAS(FRICTION)) omega = vec3(angularVelocity[invocation]);
    visitWalls(wallRadius);
    if (!touched) return;
    position[invocation] = withXyz(x, wallPoint);
    velocity[invocation] = withXyz(v, solvedVelocity);
    if (HAS(FRICTION)) angularVelocity[invocation] = vec4(omega, 0.0f);
    if (HAS(GRAVITY) || HAS(FIELDS)) {
        uint id = idOf(idAndMaterial[invocation]);
        wallWork[id] = wallWork[id] - dot3(accelerationAt(wallPoint), pushedOut) / inverseMassOf(v);
    }
}
