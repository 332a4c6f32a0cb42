// Pushes spheres out of walls and obstacles. With restitution, the running velocity bounces at once, with the speed at
// the moment of impact: sqrt(v0^2 + 2 g gap) from the gap that was open before the substep; with the speed at its end,
// a bounce of e = 0.8 would gain or lose percents of its height.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"

BUFFER(0, restrict, vec4, position, PositionBlock)
BUFFER(1, restrict, vec4, velocity, VelocityBlock)
BUFFER(2, restrict, vec4, before, BeforeBlock)
BUFFER(3, readonly, Obstacle, obstacles, ObstacleBlock)
BUFFER(4, readonly, uint, id, IdBlock)
BUFFER(5, readonly, float, bounce, BounceBlock)

PRIVATE(vec3, wallPoint)  // where the sphere is, as the pushes go on
PRIVATE(vec3, running)    // velocity before the substep, then after the bounces
PRIVATE(vec3, corrected)  // velocity with the pushes
PRIVATE(float, sphereBounce)
PRIVATE(bool, met)

void visitWall(vec3 normal, float depth, float wallRestitution) {
    met = true;
    if (HAS(RESTITUTION)) {
        float h = params.substep;
        float start = dot3(running, normal);
        float pull = HAS(GRAVITY) ? dot3(vec3(params.gravity), normal) : 0.0f;
        precise float gap = max(-depth - (start * h + 0.5f * pull * h * h), 0.0f);
        float impact = sqrt(max(start * start - 2.0f * pull * gap, 0.0f));
        float after = min(sphereBounce, wallRestitution) * impact;
        if (depth > 0.0f || start < 0.0f) running = running + normal * (after - start);
    }
    float push = max(depth, 0.0f);
    wallPoint = wallPoint + normal * push;
    // A wall stops what comes; it does not throw.
    float speed = dot3(corrected, normal);
    float stopped = max(speed, min(speed + push * params.perSubstep, 0.0f));
    corrected = corrected + normal * (stopped - speed);
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
    met = false;
    vec4 u = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (HAS(RESTITUTION)) {
        u = before[invocation];
        running = vec3(u);
        sphereBounce = HAS(RESTITUTIONS) ? bounce[id[invocation]] : params.restitution;
    }
    visitWalls(radius);
    if (!met) return;
    position[invocation] = vec4(wallPoint, x.w);
    velocity[invocation] = vec4(corrected, v.w);
    if (HAS(RESTITUTION)) before[invocation] = vec4(running, u.w);
}
