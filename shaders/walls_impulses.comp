// Walls and obstacles in the model `fast`: applies the impulse of restitution and friction, then moves the sphere out
// of the wall. The speed at the moment of impact follows from the depth: sqrt(v^2 - 2 g depth), so that a bounce
// neither gains nor loses height.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/friction.h"

BUFFER(restrict, vec4, position)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(restrict, float, wallWork)  // by id: work of pushes out of walls against gravity (J)

PRIVATE(uint, wallSphere)
PRIVATE(float, wallRadius)
PRIVATE(vec3, wallPoint)
PRIVATE(vec3, solvedVelocity)  // m/s
PRIVATE(vec3, omega)           // rad/s
PRIVATE(bool, touched)

#include "shared/contact_params.h"
#include "shared/friction_wall.h"

// The change of the normal speed in an impact (m/s). `speed` is the normal speed before the impact (m/s, negative).
// `pull` is gravity along the normal (m/s^2). `depth` is the depth of the sphere in the wall (m). It is a function of
// its own, so that `precise` applies to nothing else.
float impactChange(float speed, float pull, float depth, float restitution) {
    precise float impact = sqrt(max(speed * speed + 2.0f * pull * depth, 0.0f));
    precise float change = restitution * impact - speed;
    return change;
}

void visitWall(vec3 normal, float depth, uint wallMaterial, uint surface) {
    touched = true;
    vec4 contact = contactParams[wallContactIndex(wallSphere, wallMaterial)].contact;
    float push = max(depth, 0.0f);
    wallPoint = wallPoint + normal * push;
    float speed = dot3(solvedVelocity, normal);
    if (speed >= 0.0f) return;
    float pull = HAS(GRAVITY) ? dot3(vec3(params.gravity), normal) : 0.0f;
    float speedChange = impactChange(speed, pull, push, restitutionOf(contact));
    solvedVelocity = solvedVelocity + normal * speedChange;
    if (HAS(FRICTION)) applyWallFriction(normal, wallRadius, speedChange, contact);
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
    touched = false;
    if (HAS(FRICTION)) omega = vec3(angularVelocity[invocation]);
    visitWalls(wallRadius);
    if (!touched) return;
    position[invocation] = withXyz(x, wallPoint);
    velocity[invocation] = withXyz(v, solvedVelocity);
    if (HAS(FRICTION)) angularVelocity[invocation] = vec4(omega, 0.0f);
    if (HAS(GRAVITY)) {
        uint id = idOf(idAndMaterial[invocation]);
        wallWork[id] = wallWork[id] - dot3(vec3(params.gravity), wallPoint - vec3(x)) / inverseMassOf(v);
    }
}
