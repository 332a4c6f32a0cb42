// Gathers what the sphere in the slot of the launch touches.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/wrap.h"
#include "shared/shapes.h"
#include "shared/moving.h"
#include "shared/contact.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(readonly, uint, obstacleLists)
BUFFER(readonly, uvec2, nearObstacles)
BUFFER(readonly, vec4, listReference)
BUFFER(readonly, uint, counters)
BUFFER(coherent, uint, inspected)  // number of contacts; then two words for each: see layout.h

PRIVATE(vec3, spherePoint)
PRIVATE(float, sphereRadius)

void note(uint body, float overlap) {
    uint place = atomicAdd(inspected[0], 1u);
    if (place >= INSPECTED_MOST) return;
    inspected[1u + 2u * place] = body;
    inspected[2u + 2u * place] = floatBitsToUint(overlap);
}

bool looksAhead() {
    return false;
}

vec3 velocityAlong() {
    return vec3(0.0f, 0.0f, 0.0f);
}

void visitSurface(bool where, vec3 normal, float separation, float recession, uint wallMaterial, uint surface,
                  uint key) {
    if (separation < TOUCHES * sphereRadius) note(INSPECTED_SURFACE | surface, -separation / sphereRadius);
}

#include "shared/mesh_layout.h"
#include "shared/gathered_contacts.h"
#include "shared/surfaces.h"

KERNEL(params.spheres) {
    vec4 own = position[phase];
    bool still = HAS(FIXED) && isFixed(velocity[phase]);
    if (invocation == phase) {
        if (still || !finite3(vec3(own))) return;
        sphereRadius = radiusOf(own);
        spherePoint = wrapped(vec3(own));
        gathered = 0u;
        visitSurfaces(HAS(OBSTACLES) ? obstaclesNear(invocation, 0.0f) : NO_OBSTACLES);
        return;
    }
    if (!HAS(CONTACTS)) return;
    vec4 other = position[invocation];
    vec3 d = separation(vec3(own), vec3(other));
    float reach = radiusSum(own, other);
    float touch = reach * (1.0f + TOUCH_TOLERANCE);
    float squared = dot3(d, d);
    if (!(squared < touch * touch)) return;
    if (still && isFixed(velocity[invocation])) return;
    note(idOf(idAndMaterial[invocation]), (reach - sqrt(squared)) / smallerRadius(own, other));
}
