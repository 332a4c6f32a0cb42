// First pass of the figures of each sphere: counts the walls and obstacles that it touches, and finds the largest overlap
// with one.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/wrap.h"
#include "shared/shapes.h"
#include "shared/moving.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(readonly, uint, obstacleLists)
BUFFER(readonly, uvec2, nearObstacles)
BUFFER(readonly, vec4, listReference)
BUFFER(readonly, uint, counters)
BUFFER(writeonly, uint, touching)  // walls and obstacles that each sphere touches
BUFFER(writeonly, uint, deepest)   // bits of the largest depth / r of each sphere, at least 0

PRIVATE(vec3, spherePoint)
PRIVATE(float, sphereRadius)
PRIVATE(float, depth)
PRIVATE(uint, touched)

bool looksAhead() {
    return false;
}

vec3 velocityAlong() {
    return vec3(0.0f, 0.0f, 0.0f);
}

void visitSurface(bool where, vec3 normal, float separation, float recession, uint wallMaterial, uint surface,
                  uint key) {
    depth = max(depth, -separation);
    if (separation < TOUCHES * sphereRadius) touched = touched + 1u;
}

#include "shared/mesh_layout.h"
#include "shared/gathered_contacts.h"
#include "shared/surfaces.h"

KERNEL(params.spheres) {
    vec3 x = vec3(position[invocation]);
    vec4 v = velocity[invocation];
    depth = 0.0f;
    touched = 0u;
    sphereRadius = radiusOf(position[invocation]);
    bool meets = finite3(x) && finite3(vec3(v)) && !(HAS(FIXED) && isFixed(v));
    if (meets) {
        spherePoint = wrapped(x);
        gathered = 0u;
        visitSurfaces(HAS(OBSTACLES) ? obstaclesNear(invocation, 0.0f) : NO_OBSTACLES);
    }
    touching[invocation] = touched;
    deepest[invocation] = depth > 0.0f ? floatBitsToUint(depth / sphereRadius) : 0u;  // not -0: its bits are large
}
