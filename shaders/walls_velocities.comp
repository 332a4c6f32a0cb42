// Last word on the velocity of spheres at walls and obstacles: away with what the bounce gave, never into them.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, restrict, vec4, velocity, VelocityBlock)
BUFFER(2, readonly, vec4, before, BeforeBlock)
BUFFER(3, readonly, Obstacle, obstacles, ObstacleBlock)
BUFFER(4, readonly, uint, id, IdBlock)
BUFFER(5, readonly, float, bounce, BounceBlock)

PRIVATE(vec3, wallPoint)
PRIVATE(vec3, running)
PRIVATE(vec3, corrected)
PRIVATE(float, sphereBounce)

void visitWall(vec3 normal, float depth, float wallRestitution) {
    float speed = dot3(corrected, normal);
    precise float wanted = max(speed, 0.0f);
    if (HAS(RESTITUTION)) {
        // Negative where neighbours have pushed the sphere at the wall since its bounce.
        float start = dot3(running, normal);
        wanted = start < 0.0f ? -min(sphereBounce, wallRestitution) * start : start;
        running = running + normal * (wanted - start);
    }
    corrected = corrected + normal * (wanted - speed);
}

#include "shared/walls.h"

KERNEL(params.spheres) {
    vec4 x = position[invocation];
    float radius = HAS(RADII) ? x.w : params.radius;
    wallPoint = vec3(x);
    if (clearOfWalls(wallPoint, radius)) return;
    vec4 v = velocity[invocation];
    if (HAS(SLEEP) && v.w < 0.0f) return;
    corrected = vec3(v);
    if (HAS(RESTITUTION)) {
        running = vec3(before[invocation]);
        sphereBounce = HAS(RESTITUTIONS) ? bounce[id[invocation]] : params.restitution;
    }
    visitWalls(radius);
    velocity[invocation] = vec4(corrected, v.w);
}
