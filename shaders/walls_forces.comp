// Walls and obstacles in the model `accurate`. The springs are those between spheres, and a wall is a sphere of
// infinite mass and radius. The displacement of the tangential spring at each wall is stored with the wall's number.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/fields.h"
#include "shared/friction.h"
#include "shared/shapes.h"
#include "shared/moving.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, positionLow)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(restrict, vec4, deltaVelocity)
BUFFER(restrict, vec4, deltaOmega)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(readonly, uint, obstacleLists)
BUFFER(readonly, uvec2, nearObstacles)
BUFFER(readonly, vec4, listReference)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(restrict, vec4, wallSlip)  // by id, params.maxWallHistory each: displacement (m); w: surface + 1
BUFFER(coherent, uint, counters)
BUFFER(coherent, uint, surfaceSums)

#define NO_ENTRY 0xffffffffu

PRIVATE(uint, sphereSlot)
PRIVATE(float, sphereRadius)
PRIVATE(vec3, spherePoint)
PRIVATE(vec3, residual)   // of the position beyond float32 (m)
PRIVATE(vec3, sphereVelocity)  // m/s
PRIVATE(vec3, omega)      // rad/s
PRIVATE(vec3, impulseSum) // of all walls together (N s)
PRIVATE(vec3, torque)     // times the substep (N s m)
PRIVATE(vec3, impulseHere)  // of one wall, in scenes with contact sums (N s)
PRIVATE(vec3, momentHere)   // the same about the centre of the sphere (N m s)
PRIVATE(vec3, displacement)
PRIVATE(float, sphereInverseMass)
PRIVATE(float, yieldAlong)  // 1/kg: reciprocal of the mass that a driven body has along the surface, 0 without one
PRIVATE(uint, touchedWalls)  // one bit for each remembered wall that the sphere still touches

#include "shared/contact_params.h"
#include "shared/deltas.h"
#include "shared/spring.h"
#include "shared/surface_sums.h"

// The index of the displacement of this contact in `wallSlip`: its present entry, or a free one. NO_ENTRY if there is
// none.
uint slipEntry(uint key) {
    uint first = idOf(idAndMaterial[sphereSlot]) * params.maxWallHistory;
    uint freeEntry = NO_ENTRY;
    for (uint k = 0u; k < params.maxWallHistory; ++k) {
        vec4 stored = wallSlip[first + k];
        if (isAtSurface(stored, key)) return first + k;
        if (!hasSlip(stored) && freeEntry == NO_ENTRY) freeEntry = first + k;
    }
    return freeEntry;
}

vec3 relativeVelocity() {
    if (!HAS(MOTION)) return sphereVelocity;
    return sphereVelocity - surfaceVelocity;
}

// `fall` is the velocity that gravity and fields have added since the middle of the last motion (m/s). `arm` is the
// distance from the centre to the wall (m).
void applySpringFriction(vec3 n, uint key, vec3 fall, float arm, Spring spring, vec4 contact) {
    uint entry = slipEntry(key);
    bool known = entry != NO_ENTRY && hasSlip(wallSlip[entry]);
    displacement = known ? rotateToPlane(vec3(wallSlip[entry]), n) : vec3(0.0f, 0.0f, 0.0f);
    vec3 relative = relativeVelocity();
    vec3 slip = relative - n * dot3(relative, n) - cross3(omega, n) * arm;
    vec3 path = slip;
    if (HAS(GRAVITY) || HAS(FIELDS)) path = slip - (fall - n * dot3(fall, n));
    float lever = arm / sphereRadius;
    float inverseMass = sphereInverseMass * (1.0f + 2.5f * lever * lever);
    if (HAS(DRIVES)) inverseMass = inverseMass + yieldAlong;
    vec3 impulse = tangentialImpulse(path, slip, inverseMass, spring, frictionOf(contact));
    impulseSum = impulseSum + impulse;
    torque = torque - cross3(n, impulse) * arm;
    if (HAS(CONTACT_SUMS) || HAS(DRIVES)) {
        impulseHere = impulseHere + impulse;
        precise vec3 moment = cross3(n, impulse) * -arm;
        momentHere = moment;
    }
    if (HAS(ROLLING)) {
        float c = 2.5f * sphereInverseMass / (sphereRadius * sphereRadius);
        vec3 spin = omega;
        if (HAS(MOTION)) spin = spin - surfaceSpin;
        float about = dot3(spin, n);
        float maxMoment = sphereRadius * spring.impulse;
        vec3 rolling = rollingMoment(spin - n * about, c, rollingResistanceOf(contact) * maxMoment);
        vec3 spinning = spinningMoment(n, about, c, spinningResistanceOf(contact) * maxMoment);
        torque = torque + rolling + spinning;
        if (HAS(CONTACT_SUMS) || HAS(DRIVES)) {
            precise vec3 moment = momentHere + rolling + spinning;
            momentHere = moment;
        }
    }
    if (entry == NO_ENTRY) {
        atomicAdd(counters[COUNTER_DROPPED_WALLS], 1u);
        return;
    }
    wallSlip[entry] = vec4(displacement, float(key + 1u));
    touchedWalls = touchedWalls | (1u << (entry - idOf(idAndMaterial[sphereSlot]) * params.maxWallHistory));
}

bool looksAhead() {
    return false;
}

vec3 velocityAlong() {
    return vec3(0.0f, 0.0f, 0.0f);
}

void visitSurface(bool where, vec3 normal, float separation, float recession, uint wallMaterial, uint surface,
                  uint key) {
    float overlap = -separation - dot3(residual, normal);
    if (!(overlap > 0.0f)) return;
    uint index = wallContactIndex(sphereSlot, wallMaterial);
    float speed = dot3(relativeVelocity(), normal);
    if (HAS(MOTION)) {
        float motion = -speed * params.substep;
        RAISE_TO(motion > sphereRadius * SAFE_MOTION, counters[COUNTER_LARGEST_MOTION], motion / sphereRadius)
    }
    vec3 fall = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(GRAVITY) || HAS(FIELDS)) {
        vec3 pull = accelerationAt(spherePoint, sphereRadius, sphereInverseMass);
        fall = pull * (0.5f * params.substep);
    }
    float inverseMass = sphereInverseMass;  // of the sphere and the body that it touches
    if (HAS(DRIVES)) yieldAlong = 0.0f;
    if (HAS(DRIVES) && driveRow != 0u) {
        float across = dot3(driveLever, normal);
        inverseMass = inverseMass + driveYield * across * across;
        yieldAlong = driveYield * max(dot3(driveLever, driveLever) - across * across, 0.0f);
    }
    Spring spring = springOf(overlap, speed - dot3(fall, normal), speed, sphereRadius, inverseMass,
                             contactParams[index].stiffness);
    impulseSum = impulseSum + normal * spring.impulse;
    if (HAS(CONTACT_SUMS) || HAS(DRIVES)) {
        impulseHere = normal * spring.impulse;
        momentHere = vec3(0.0f, 0.0f, 0.0f);
    }
    if (HAS(FRICTION))
        applySpringFriction(normal, key, fall, sphereRadius - overlap, spring, contactParams[index].contact);
    if (!HAS(CONTACT_SUMS) && !HAS(DRIVES)) return;
    precise vec3 moment = cross3(spherePoint, impulseHere) + momentHere;
    if (HAS(CONTACT_SUMS)) addToSurfaceSums(sphereSlot, surface, impulseHere, moment);
    if (HAS(DRIVES) && driveRow != 0u) addToSurfaceSums(sphereSlot, driveRow, impulseHere, moment);
}

#include "shared/mesh_layout.h"
#include "shared/gathered_contacts.h"
#include "shared/surfaces.h"

void clearUntouchedSlip() {
    uint first = idOf(idAndMaterial[sphereSlot]) * params.maxWallHistory;
    for (uint k = 0u; k < params.maxWallHistory; ++k)
        if ((touchedWalls & (1u << k)) == 0u && hasSlip(wallSlip[first + k]))
            wallSlip[first + k] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
}

KERNEL(params.spheres) {
    vec4 x = position[invocation];
    sphereSlot = invocation;
    sphereRadius = radiusOf(x);
    spherePoint = vec3(x);
    vec4 spin = vec4(0.0f, 0.0f, 0.0f, 0.0f);  // w: 1 while any wall is remembered
    if (HAS(FRICTION)) spin = angularVelocity[invocation];
    float reach = TOUCHES * sphereRadius;
    uint near = HAS(OBSTACLES) ? obstaclesNear(invocation, reach) : NO_OBSTACLES;
    if (!remembersWall(spin) && near == NO_OBSTACLES && clearOfFaces(reach)) return;
    residual = vec3(positionLow[invocation]);
    vec4 v = velocity[invocation];
    if (HAS(FIXED) && isFixed(v)) return;
    sphereInverseMass = awakeInverseMass(v);
    sphereVelocity = vec3(v);
    impulseSum = vec3(0.0f, 0.0f, 0.0f);
    torque = vec3(0.0f, 0.0f, 0.0f);
    omega = vec3(spin);
    touchedWalls = 0u;
    gathered = 0u;
    visitSurfaces(near);
    addDeltaVelocity(invocation, impulseSum * sphereInverseMass);
    if (HAS(FRICTION)) {
        addDeltaOmega(invocation, torque * (2.5f * sphereInverseMass / (sphereRadius * sphereRadius)));
        angularVelocity[invocation] = vec4(omega, touchedWalls != 0u ? 1.0f : 0.0f);
        if (remembersWall(spin)) clearUntouchedSlip();
    }
}
