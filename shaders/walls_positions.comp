// Pushes spheres out of walls and obstacles. With restitution, the bounce velocity changes at once, with the speed at
// the moment of impact. This speed is sqrt(v0^2 + 2 g gap), from the gap before the substep. With the speed at the end
// of the substep, a bounce of e = 0.8 would gain or lose percents of its height.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"

BUFFER(restrict, vec4, position)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, velocityBefore)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(writeonly, vec4, wallImpulse)  // sum of the pushes (m/s)

PRIVATE(uint, wallSphere)
PRIVATE(float, wallRadius)
PRIVATE(vec3, wallPoint)  // position, updated by each push (m)
PRIVATE(vec3, bounceVelocity)  // velocity before the substep, then after the bounces (m/s)
PRIVATE(vec3, solvedVelocity)  // velocity with the pushes (m/s)
PRIVATE(vec3, pushes)
PRIVATE(bool, touched)

#include "shared/contact_params.h"

// Static friction by position: undoes the motion along the wall by gravity, which friction would have prevented.
// (walls_velocities.comp handles velocities. Between spheres this is left out: in a pile, it would increase the jitter
// by the pushes more than it would stop the slow drift.)
void holdByFriction(vec3 n, float most) {
    float h = params.substep;
    vec3 along = (vec3(params.gravity) - n * dot3(vec3(params.gravity), n)) * (0.5f * h * h);
    float squared = dot3(along, along);
    wallPoint = wallPoint - along * (squared > most * most ? most / sqrt(squared) : 1.0f);
}

void visitWall(vec3 normal, float depth, uint wallMaterial, uint surface) {
    touched = true;
    vec4 contact = contactParams[wallContactIndex(wallSphere, wallMaterial)].contact;
    if (HAS(RESTITUTION)) {
        float h = params.substep;
        float startSpeed = dot3(bounceVelocity, normal);
        float pull = HAS(GRAVITY) ? dot3(vec3(params.gravity), normal) : 0.0f;
        precise float gap = max(-depth - (startSpeed * h + 0.5f * pull * h * h), 0.0f);
        float impact = sqrt(max(startSpeed * startSpeed - 2.0f * pull * gap, 0.0f));
        float bounceSpeed = restitutionOf(contact) * impact;
        if (depth > 0.0f || startSpeed < 0.0f) bounceVelocity = bounceVelocity + normal * (bounceSpeed - startSpeed);
    }
    float push = max(depth, 0.0f);
    wallPoint = wallPoint + normal * push;
    // A wall stops a sphere that comes, but does not throw it back.
    float speed = dot3(solvedVelocity, normal);
    float stopped = max(speed, min(speed + push * params.perSubstep, 0.0f));
    solvedVelocity = solvedVelocity + normal * (stopped - speed);
    if (HAS(FRICTION)) {
        pushes = pushes + normal * (stopped - speed);
        if (HAS(GRAVITY)) holdByFriction(normal, frictionOf(contact) * push);
    }
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
    vec4 u = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (HAS(RESTITUTION)) {
        u = velocityBefore[invocation];
        bounceVelocity = vec3(u);
    }
    if (HAS(FRICTION)) {
        pushes = vec3(0.0f, 0.0f, 0.0f);
    }
    visitWalls(wallRadius);
    if (HAS(FRICTION)) wallImpulse[invocation] = vec4(pushes, 0.0f);
    if (!touched) return;
    position[invocation] = withXyz(x, wallPoint);
    velocity[invocation] = withXyz(v, solvedVelocity);
    if (HAS(RESTITUTION)) velocityBefore[invocation] = withXyz(u, bounceVelocity);
}
