// Sets the normal speed of spheres at walls and obstacles: away from them with the speed of the bounce, never into
// them.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/id_and_material.h"

BUFFER(readonly, vec4, position)
BUFFER(restrict, vec4, velocity)
BUFFER(readonly, vec4, velocityBefore)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(restrict, vec4, wallImpulse)

PRIVATE(uint, wallSphere)
PRIVATE(float, wallRadius)
PRIVATE(vec3, wallPoint)
PRIVATE(vec3, running)
PRIVATE(vec3, solvedVelocity)
PRIVATE(vec3, pushes)

#include "shared/wall_contact_params.h"

void visitWall(vec3 normal, float depth, uint wallMaterial, uint surface) {
    vec4 law = contactParams[wallContactIndex(wallMaterial)].contact;
    float speed = dot3(solvedVelocity, normal);
    precise float wanted = max(speed, 0.0f);
    if (HAS(RESTITUTION)) {
        // The speed is negative if neighbours have pushed the sphere at the wall since its bounce.
        float start = dot3(running, normal);
        wanted = start < 0.0f ? -law.x * start : start;
        running = running + normal * (wanted - start);
    }
    solvedVelocity = solvedVelocity + normal * (wanted - speed);
    if (HAS(FRICTION)) pushes = pushes + normal * (wanted - speed);
}

#include "shared/walls.h"

KERNEL(params.spheres) {
    vec4 x = position[invocation];
    wallSphere = invocation;
    wallRadius = HAS(RADII) ? x.w : params.radius;
    wallPoint = vec3(x);
    if (clearOfWalls(wallPoint, wallRadius)) return;
    vec4 v = velocity[invocation];
    if (HAS(SLEEP) && v.w < 0.0f) return;
    solvedVelocity = vec3(v);
    if (HAS(RESTITUTION)) running = vec3(velocityBefore[invocation]);
    if (HAS(FRICTION)) pushes = vec3(wallImpulse[invocation]);
    visitWalls(wallRadius);
    velocity[invocation] = vec4(solvedVelocity, v.w);
    if (HAS(FRICTION)) wallImpulse[invocation] = vec4(pushes, 0.0f);
}
