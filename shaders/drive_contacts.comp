// In the model `balanced`: counts the contacts of driven bodies in this substep. Counts too many rather than too few.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/shapes.h"
#include "shared/moving.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(readonly, uint, obstacleLists)
BUFFER(readonly, uvec2, nearObstacles)
BUFFER(readonly, vec4, listReference)
BUFFER(readonly, uint, counters)
BUFFER(coherent, uint, surfaceSums)

PRIVATE(vec3, spherePoint)     // m
PRIVATE(float, sphereRadius)   // m
PRIVATE(vec3, sphereVelocity)  // m/s

#include "shared/surface_sums.h"

bool looksAhead() {
    return true;
}

vec3 velocityAlong() {
    return sphereVelocity;
}

void visitSurface(bool where, vec3 normal, float separation, float recession, uint wallMaterial, uint surface,
                  uint key) {
    if (driveRow == 0u) return;
    vec3 relative = sphereVelocity - surfaceVelocity;
    float reach = sqrt(dot3(relative, relative)) * params.substep + TOUCHES * sphereRadius;
    if (separation < reach) atomicAdd(surfaceSums[DRIVE_CONTACTS], 1u);
}

#include "shared/mesh_layout.h"
// Only `accurate` gathers contacts.
void gather(vec4 surface, Obstacle mesh, uint key) {}
void visitGathered(Obstacle mesh) {}

#include "shared/surfaces.h"

KERNEL(params.spheres) {
    vec4 v = velocity[invocation];
    if (!isAwake(v)) return;
    vec4 x = position[invocation];
    spherePoint = vec3(x);
    sphereRadius = radiusOf(x);
    sphereVelocity = vec3(v);
    // A body is no faster than the path of the obstacles allows.
    float path = sqrt(dot3(sphereVelocity, sphereVelocity)) * params.substep + params.obstaclePath;
    uint near = obstaclesNear(invocation, path + TOUCHES * sphereRadius);
    if (near == NO_OBSTACLES) return;
    setSurfaceAtRest();
    visitObstacles(near);
}
