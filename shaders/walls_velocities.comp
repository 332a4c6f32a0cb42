// Sets the normal speed of spheres at walls and obstacles: away from them with the speed of the bounce, never into
// them.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"

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
PRIVATE(vec3, bounceVelocity)
PRIVATE(vec3, solvedVelocity)
PRIVATE(vec3, pushes)

#include "shared/contact_params.h"

void visitWall(vec3 normal, float depth, uint wallMaterial, uint surface) {
    vec4 contact = contactParams[wallContactIndex(wallSphere, wallMaterial)].contact;
    float speed = dot3(solvedVelocity, normal);
    precise float target = max(speed, 0.0f);
    if (HAS(RESTITUTION)) {
        // The speed is negative if neighbours have pushed the sphere at the wall since its bounce.
        float startSpeed = dot3(bounceVelocity, normal);
        target = startSpeed < 0.0f ? -restitutionOf(contact) * startSpeed : startSpeed;
        bounceVelocity = bounceVelocity + normal * (target - startSpeed);
    }
    solvedVelocity = solvedVelocity + normal * (target - speed);
    if (HAS(FRICTION)) pushes = pushes + normal * (target - speed);
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
    if (HAS(RESTITUTION)) bounceVelocity = vec3(velocityBefore[invocation]);
    if (HAS(FRICTION)) pushes = vec3(wallImpulse[invocation]);
    visitWalls(wallRadius);
    velocity[invocation] = withXyz(v, solvedVelocity);
    if (HAS(FRICTION)) wallImpulse[invocation] = vec4(pushes, 0.0f);
}
