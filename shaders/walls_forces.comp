// Walls and obstacles in the model `accurate`. The springs are those between spheres, and a wall is a sphere of
// infinite mass and radius. The displacement of the tangential spring at each wall is stored with the wall's number.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/id_and_material.h"
#include "shared/friction.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, positionLow)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(restrict, vec4, deltaVelocity)
BUFFER(restrict, vec4, deltaOmega)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(restrict, vec4, wallSlip)  // by id, params.wallContacts each: displacement (m); w: surface + 1
BUFFER(coherent, uint, counters)

#define NO_PLACE 0xffffffffu

PRIVATE(uint, wallSphere)
PRIVATE(float, wallRadius)
PRIVATE(vec3, wallPoint)
PRIVATE(vec3, residual)   // of the position beyond float32 (m)
PRIVATE(vec3, moving)     // velocity (m/s)
PRIVATE(vec3, omega)      // rad/s
PRIVATE(vec3, push)       // of all walls together (N s)
PRIVATE(vec3, torque)     // times the substep (N s m)
PRIVATE(vec3, displacement)
PRIVATE(float, inverseMass)
PRIVATE(uint, seen)       // one bit for each remembered wall that the sphere still touches

#include "shared/wall_contact_params.h"
#include "shared/deltas.h"
#include "shared/spring.h"

// The index of the displacement at this surface in `wallSlip`: its present entry, or a free one. NO_PLACE if there is
// none.
uint placeOf(uint surface) {
    uint first = idOf(idAndMaterial[wallSphere]) * params.wallContacts;
    uint empty = NO_PLACE;
    for (uint k = 0u; k < params.wallContacts; ++k) {
        float owner = wallSlip[first + k].w;
        if (owner == float(surface + 1u)) return first + k;
        if (owner == 0.0f && empty == NO_PLACE) empty = first + k;
    }
    return empty;
}

// `fall` is the velocity that gravity has added since the middle of the last motion (m/s). `arm` is the distance from
// the centre to the wall (m).
void applySpringFriction(vec3 n, uint surface, vec3 fall, float arm, Spring spring, vec4 law) {
    uint place = placeOf(surface);
    bool known = place != NO_PLACE && wallSlip[place].w != 0.0f;
    displacement = known ? rotateToPlane(vec3(wallSlip[place]), n) : vec3(0.0f, 0.0f, 0.0f);
    vec3 slip = moving - n * dot3(moving, n) - cross3(omega, n) * arm;
    vec3 path = slip;
    if (HAS(GRAVITY)) path = slip - (fall - n * dot3(fall, n));
    float lever = arm / wallRadius;
    vec3 impulse = tangentialImpulse(path, slip, inverseMass * (1.0f + 2.5f * lever * lever), spring, law.y);
    push = push + impulse;
    torque = torque - cross3(n, impulse) * arm;
    if (HAS(ROLLING)) {
        float c = 2.5f * inverseMass / (wallRadius * wallRadius);
        float about = dot3(omega, n);
        float most = wallRadius * spring.impulse;
        torque = torque + rollingMoment(omega - n * about, c, law.z * most) +
                 spinningMoment(n, about, c, law.w * most);
    }
    if (place == NO_PLACE) {
        atomicAdd(counters[COUNTER_FORGOTTEN], 1u);
        return;
    }
    wallSlip[place] = vec4(displacement, float(surface + 1u));
    seen = seen | (1u << (place - idOf(idAndMaterial[wallSphere]) * params.wallContacts));
}

void visitWall(vec3 normal, float depth, uint wallMaterial, uint surface) {
    float overlap = depth - dot3(residual, normal);
    if (!(overlap > 0.0f)) return;
    uint index = wallContactIndex(wallMaterial);
    float speed = dot3(moving, normal);
    vec3 fall = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(GRAVITY)) fall = vec3(params.gravity) * (0.5f * params.substep);
    Spring spring =
        springOf(overlap, speed - dot3(fall, normal), speed, wallRadius, inverseMass, contactParams[index].stiffness);
    push = push + normal * spring.impulse;
    if (HAS(FRICTION)) applySpringFriction(normal, surface, fall, wallRadius - overlap, spring, contactParams[index].contact);
}

#include "shared/walls.h"

void forget() {
    uint first = idOf(idAndMaterial[wallSphere]) * params.wallContacts;
    for (uint k = 0u; k < params.wallContacts; ++k)
        if ((seen & (1u << k)) == 0u && wallSlip[first + k].w != 0.0f)
            wallSlip[first + k] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
}

KERNEL(params.spheres) {
    vec4 x = position[invocation];
    wallSphere = invocation;
    wallRadius = HAS(RADII) ? x.w : params.radius;
    wallPoint = vec3(x);
    vec4 spin = vec4(0.0f, 0.0f, 0.0f, 0.0f);  // w: 1 while any wall is remembered
    if (HAS(FRICTION)) spin = angularVelocity[invocation];
    if (spin.w == 0.0f && clearOfWalls(wallPoint, wallRadius)) return;
    residual = vec3(positionLow[invocation]);
    vec4 v = velocity[invocation];
    inverseMass = v.w;
    moving = vec3(v);
    push = vec3(0.0f, 0.0f, 0.0f);
    torque = vec3(0.0f, 0.0f, 0.0f);
    omega = vec3(spin);
    seen = 0u;
    visitWalls(wallRadius);
    addDeltaVelocity(invocation, push * inverseMass);
    if (HAS(FRICTION)) {
        addDeltaOmega(invocation, torque * (2.5f * inverseMass / (wallRadius * wallRadius)));
        angularVelocity[invocation] = vec4(omega, seen != 0u ? 1.0f : 0.0f);
        if (spin.w != 0.0f) forget();
    }
}
