// Adds up the spheres with finite states and counts the others, in parts of STATISTIC_BLOCK spheres. The host adds up
// the parts. Fixed spheres are counted and take part in no sum.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/wrap.h"
#include "shared/fields.h"
#include "shared/shapes.h"
#include "shared/moving.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, positionLow)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, vec4, angularVelocity)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(readonly, uint, obstacleLists)
BUFFER(readonly, uvec2, nearObstacles)
BUFFER(readonly, vec4, listReference)
BUFFER(readonly, uint, counters)
BUFFER(writeonly, SphereStatistics, sphereSums)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(readonly, vec4, wallSlip)
BUFFER(readonly, uvec4, images)
BUFFER(writeonly, uint, touching)  // walls and obstacles that each sphere touches

PRIVATE(uint, sphereSlot)
PRIVATE(vec3, spherePoint)
PRIVATE(float, sphereRadius)
PRIVATE(float, deepest)
PRIVATE(uint, touched)
PRIVATE(vec3, displacement)
PRIVATE(float, springs)

#include "shared/contact_params.h"
#include "shared/spring.h"

bool looksAhead() {
    return false;
}

vec3 velocityAlong() {
    return vec3(0.0f, 0.0f, 0.0f);
}

void visitSurface(bool where, vec3 normal, float separation, float recession, uint wallMaterial, uint surface,
                  uint key) {
    deepest = max(deepest, -separation);
    if (separation < TOUCHES * sphereRadius) touched = touched + 1u;
    if (!HAS(LOW_BITS)) return;
    float overlap = -separation - dot3(vec3(positionLow[sphereSlot]), normal);
    if (!(overlap > 0.0f)) return;
    displacement = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(FRICTION)) {
        uint first = idOf(idAndMaterial[sphereSlot]) * params.maxWallHistory;
        for (uint k = first; k < first + params.maxWallHistory; ++k)
            if (isAtSurface(wallSlip[k], key)) displacement = vec3(wallSlip[k]);
    }
    float speed = dot3(vec3(velocity[sphereSlot]), normal);
    springs += springEnergy(overlapWithSpeed(overlap, speed), sphereRadius,
                            contactParams[wallContactIndex(sphereSlot, wallMaterial)].stiffness, displacement);
}

#include "shared/mesh_layout.h"
#include "shared/gathered_contacts.h"
#include "shared/surfaces.h"

// True if spheres touch anything in this scene: without that, there is no array to count in.
bool touches() {
    return HAS(CONTACTS) || HAS(WALLS) || HAS(OBSTACLES);
}

bool outside(vec3 p) {
    return p.x < params.wallMin.x || p.x > params.wallMax.x || p.y < params.wallMin.y || p.y > params.wallMax.y ||
           p.z < params.wallMin.z || p.z > params.wallMax.z;
}

// The lengths of the periodic axes that the sphere has been moved back so far.
vec3 countedTurns(uint id) {
    uvec4 counted = images[id];
    return vec3(float(int(counted.x)), float(int(counted.y)), float(int(counted.z)));
}

KERNEL(params.statisticBlocks) {
    uint end = min(params.spheres, (invocation + 1u) * STATISTIC_BLOCK);
    float energy = 0.0f;
    vec3 momentum = vec3(0.0f, 0.0f, 0.0f);
    vec3 angular = vec3(0.0f, 0.0f, 0.0f);
    float rotation = 0.0f;
    vec4 weighted = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    float height = 0.0f;
    float fieldEnergy = 0.0f;
    vec3 flowDiagonal = vec3(0.0f, 0.0f, 0.0f);
    vec3 flowOther = flowDiagonal;
    float squares = 0.0f;
    float fastest = 0.0f;
    float overlap = 0.0f;
    springs = 0.0f;
    uint sleeping = 0u;
    uint outsideCount = 0u;
    uint nonFinite = 0u;
    uint fixedSpheres = 0u;
    for (uint k = invocation * STATISTIC_BLOCK; k < end; ++k) {
        vec3 x = vec3(position[k]);
        vec3 unwrapped = x;
        vec4 v = velocity[k];
        if (touches()) touching[k] = 0u;
        if (HAS(FIXED) && isFixed(v)) {
            fixedSpheres += 1u;
            continue;
        }
        if (!finite3(x) || !finite3(vec3(v))) {
            nonFinite += 1u;
            continue;
        }
        if (HAS(PERIODIC)) {
            unwrapped = movedBack(x, -countedTurns(idOf(idAndMaterial[k])));
            x = wrapped(x);
        }
        float mass = 1.0f / inverseMassOf(v);
        float squared = dot3(vec3(v), vec3(v));
        energy += 0.5f * mass * squared;
        momentum = momentum + vec3(v) * mass;
        angular = angular + cross3(x, vec3(v)) * mass;
        if (HAS(FRICTION)) {
            vec3 spin = vec3(angularVelocity[k]);
            float r = radiusOf(position[k]);
            float inertia = 0.4f * mass * r * r;
            angular = angular + spin * inertia;
            rotation += 0.5f * inertia * dot3(spin, spin);
        }
        weighted = weighted + vec4(unwrapped * mass, mass);
        height += x.z;
        if (HAS(CONTACT_SUMS)) {
            flowDiagonal = flowDiagonal + vec3(v.x * v.x, v.y * v.y, v.z * v.z) * mass;
            flowOther = flowOther + vec3(v.x * v.y, v.x * v.z, v.y * v.z) * mass;
        }
        if (HAS(FIELDS)) fieldEnergy += mass * fieldPotential(x, radiusOf(position[k]), inverseMassOf(v));
        squares += squared;
        fastest = max(fastest, squared);
        if (isAsleep(v)) sleeping += 1u;
        if (outside(x)) outsideCount += 1u;
        sphereSlot = k;
        spherePoint = x;
        sphereRadius = radiusOf(position[k]);
        deepest = 0.0f;
        touched = 0u;
        gathered = 0u;
        visitSurfaces(HAS(OBSTACLES) ? obstaclesNear(k, 0.0f) : NO_OBSTACLES);
        overlap = max(overlap, deepest / sphereRadius);
        if (touches()) touching[k] = touched;
    }
    sphereSums[invocation].weighted = weighted;
    sphereSums[invocation].momentum = vec4(momentum, energy);
    sphereSums[invocation].angular = vec4(angular, rotation);
    sphereSums[invocation].heightSum = height;
    sphereSums[invocation].speedSquares = squares;
    sphereSums[invocation].speedSquaredMax = fastest;
    sphereSums[invocation].wallOverlapMax = overlap;
    sphereSums[invocation].wallSprings = springs;
    sphereSums[invocation].fieldEnergy = fieldEnergy;
    sphereSums[invocation].flowDiagonal = vec4(flowDiagonal, 0.0f);
    sphereSums[invocation].flowOther = vec4(flowOther, 0.0f);
    sphereSums[invocation].sleeping = sleeping;
    sphereSums[invocation].outside = outsideCount;
    sphereSums[invocation].nonFinite = nonFinite;
    sphereSums[invocation].fixedSpheres = fixedSpheres;
}
