// Wakes the sleepers at obstacles that move, and keeps the spheres there awake.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/shapes.h"
#include "shared/moving.h"
#include "shared/wake.h"

BUFFER(readonly, vec4, position)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, restReference)  // by id; w: see accessors.h
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(readonly, uint, obstacleLists)
BUFFER(readonly, uvec2, nearObstacles)
BUFFER(readonly, vec4, listReference)
BUFFER(readonly, uint, counters)

PRIVATE(vec3, spherePoint)    // m
PRIVATE(float, sphereRadius)  // m
PRIVATE(bool, disturbed)

bool looksAhead() {
    return false;
}

vec3 velocityAlong() {
    return vec3(0.0f, 0.0f, 0.0f);
}

void visitSurface(bool where, vec3 normal, float separation, float recession, uint wallMaterial, uint surface,
                  uint key) {
    if (HAS(DRIVES) && driveRow != 0u) disturbed = disturbed || separation < wakeGap();
    float speed = sqrt(dot3(surfaceVelocity, surfaceVelocity));
    disturbed = disturbed || (speed > 0.0f && separation < wakeGap() + speed * params.substep);
}

#include "shared/mesh_layout.h"
// Only `accurate` gathers contacts.
void gather(vec4 surface, Obstacle mesh, uint key) {}
void visitGathered(Obstacle mesh) {}

#include "shared/surfaces.h"

KERNEL(params.spheres) {
    vec4 v = velocity[invocation];
    if (isFixed(v)) return;
    vec4 x = position[invocation];
    spherePoint = vec3(x);
    sphereRadius = radiusOf(x);
    disturbed = false;
    setSurfaceAtRest();
    uint near = obstaclesNear(invocation, wakeGap());
    if (near == NO_OBSTACLES) return;
    visitObstacles(near);
    if (!disturbed) return;
    if (isAsleep(v)) velocity[invocation] = sleepToggled(v);
    uint id = idOf(idAndMaterial[invocation]);
    if (!hasMovedAway(restReference[id])) restReference[id].w = 0.0f;
}
