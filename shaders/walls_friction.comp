// Friction at walls and obstacles, limited by their normal impulses in this substep.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/friction.h"

BUFFER(readonly, vec4, position)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(readonly, vec4, wallImpulse)

PRIVATE(uint, wallSphere)
PRIVATE(float, wallRadius)
PRIVATE(vec3, wallPoint)
PRIVATE(vec3, solvedVelocity)  // m/s
PRIVATE(vec3, omega)           // rad/s

#include "shared/contact_params.h"
#include "shared/friction_wall.h"

void visitWall(vec3 normal, float depth, uint wallMaterial, uint surface) {
    float normalImpulse = dot3(vec3(wallImpulse[wallSphere]), normal);
    if (normalImpulse > 0.0f)
        applyWallFriction(normal, wallRadius, normalImpulse,
                          contactParams[wallContactIndex(wallSphere, wallMaterial)].contact);
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
    omega = vec3(angularVelocity[invocation]);
    visitWalls(wallRadius);
    velocity[invocation] = withXyz(v, solvedVelocity);
    angularVelocity[invocation] = vec4(omega, 0.0f);
}
