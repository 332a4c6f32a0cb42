// Checks the motion of a sphere in a substep. The includer binds `velocity`, `listReference`, `counters`, `obstacles` and
// `obstacleLists`. It has included shared/separation.h, shared/shapes.h, shared/moving.h, shared/mesh_room.h,
// shared/fields.h, shared/outside.h, shared/drift.h, shared/falling_frame.h and shared/ask_for_lists.h.

// The time, in steps, that a sphere looks ahead. Substeps are fitted after each step to the motions in it, so that a
// sphere must see all that it may meet within two steps.
#define LOOK_AHEAD 2.0f

PRIVATE(vec3, flightVelocity)  // velocity of the sphere that looks ahead (m/s)
PRIVATE(vec3, flightAcceleration)  // its acceleration at rest (m/s^2)
PRIVATE(float, ownRadius)      // its radius (m)

// Returns true if the sphere may close the gap while it looks ahead, and if the substeps are too long for the impact.
bool mayCloseGap(float gap, vec3 normal) {
    float ahead = LOOK_AHEAD * params.step;
    float speed = -dot3(flightVelocity, normal);
    if (HAS(GRAVITY) || HAS(FIELDS)) speed = speed + max(-dot3(flightAcceleration, normal), 0.0f) * ahead;
    return speed * ahead > gap && speed * params.substep > SAFE_MOTION * ownRadius;
}

bool mayMeetFace(uint face, float separation, vec3 normal) {
    return (params.closedFaces & (1u << face)) != 0u && mayCloseGap(separation, normal);
}

bool mayMeetObstacle(Obstacle obstacle, vec3 p) {
    vec3 v = flightVelocity;
    if (HAS(MESHES) && obstacle.shape == MESH_SHAPE) {
        if (isMoving(obstacle)) flightVelocity = v - materialVelocity(obstacles[obstacle.motion], 0.0f, p);
        // The mesh may be in the direction of the flight.
        float speed = sqrt(dot3(flightVelocity, flightVelocity));
        vec3 ahead = speed > 0.0f ? flightVelocity * (-1.0f / speed) : vec3(0.0f, 0.0f, 0.0f);
        bool near = mayCloseGap(roomAtMesh(obstacle, p) - ownRadius, ahead);
        flightVelocity = v;
        return near;
    }
    bool meets = false;
    for (uint part = 0u; part < obstacle.parts; ++part) {
        vec4 surface = surfaceAt(obstacle, part, p);
        vec3 normal = vec3(surface);
        if (isMoving(obstacle))
            flightVelocity = v - materialVelocity(obstacles[obstacle.motion], 0.0f, p - normal * surface.w);
        meets = meets || mayCloseGap(surface.w - ownRadius, normal);
    }
    flightVelocity = v;
    return meets;
}

bool mayMeetSurface(vec3 p) {
    vec3 low = p - vec3(params.wallMin);
    vec3 high = vec3(params.wallMax) - p;
    if (HAS(WALLS) && (mayMeetFace(0u, low.x - ownRadius, vec3(1.0f, 0.0f, 0.0f)) ||
                       mayMeetFace(1u, high.x - ownRadius, vec3(-1.0f, 0.0f, 0.0f)) ||
                       mayMeetFace(2u, low.y - ownRadius, vec3(0.0f, 1.0f, 0.0f)) ||
                       mayMeetFace(3u, high.y - ownRadius, vec3(0.0f, -1.0f, 0.0f)) ||
                       mayMeetFace(4u, low.z - ownRadius, vec3(0.0f, 0.0f, 1.0f)) ||
                       mayMeetFace(5u, high.z - ownRadius, vec3(0.0f, 0.0f, -1.0f))))
        return true;
    if (HAS(OBSTACLES))
        for (uint k = 0u; k < params.obstacles; ++k)
            if (mayMeetObstacle(obstacles[k], p)) return true;
    return false;
}

// Returns true if a sphere outside may soon meet a wall, an obstacle or a sphere inside the bounds.
bool mayCollideSoon(vec3 p, vec3 v, float radius, float inverseOfMass) {
    flightAcceleration = accelerationAt(p, radius, inverseOfMass);
    p = wrapped(p);
    flightVelocity = v;
    ownRadius = radius;
    if (HAS(CONTACTS)) {
        vec3 nearest = vec3(min(max(p.x, params.wallMin.x), params.wallMax.x),
                            min(max(p.y, params.wallMin.y), params.wallMax.y),
                            min(max(p.z, params.wallMin.z), params.wallMax.z));
        vec3 d = p - nearest;
        float distance = sqrt(dot3(d, d));
        if (distance <= strip() || mayCloseGap(distance - strip(), d * (1.0f / distance))) return true;
    }
    return mayMeetSurface(p);
}

// The motion of the sphere in a substep (m), as far as it may carry the sphere past an object that it should hit.
// `reference` is its row of `listReference`.
float riskyMotion(vec4 sphere, float inverseOfMass, vec3 v, vec4 reference) {
    float h = params.substep;
    float motion = sqrt(dot3(v, v) * h * h);
    vec3 p = vec3(sphere);
    if (!(beyond(p) > 0.0f) || mayCollideSoon(p, v, radiusOf(sphere), inverseOfMass)) return motion;
    if (!HAS(CONTACTS) || roomOf(reference) >= UNLIMITED_ROOM || counters[COUNTER_REBUILDS] == 0u) return 0.0f;
    // Among spheres outside, only its motion relative to their frame counts.
    vec3 drift = v - frameVelocity();
    float speed = sqrt(dot3(drift, drift));
    vec3 since = p - vec3(reference) - framePath();
    float used = sqrt(dot3(since, since)) + speed * LOOK_AHEAD * params.step;
    return roomOf(reference) > 0.0f && used < 0.5f * roomOf(reference) ? 0.0f : speed * h;
}

// Returns true if the lists may lack a pair of this sphere, which has moved to `to` with velocity `v`, or will lack it
// after `ahead` further substeps.
bool leavesLists(vec3 to, vec3 v, vec4 reference, float radius, float ahead) {
    float time = params.substep * ahead;
    vec3 later = to + v * time;
    if (HAS(PERIODIC) && mustWrap(later)) return true;
    vec3 since = to - vec3(reference);
    vec3 drifted = since - driftPath();
    float moved = sqrt(dot3(drifted, drifted));
    vec3 relative = v - driftVelocity();
    // In `balanced`, the lists must hold to the end of the next substep.
    if (HAS(BALANCED)) moved = moved + sqrt(dot3(relative, relative)) * params.substep;
    moved = moved + mostNext(sqrt(dot3(v, v)) * params.substep) * ahead;
    bool leftMargin = moved > params.rebuildMove + moreMotionOf(reference.w);
    if (roomOf(reference) == 0.0f) return leftMargin;
    if (leftMargin && !(beyondStrip(to) && beyondStrip(vec3(reference)))) return true;
    if (lost(vec4(vec3(reference), radius))) return !lost(vec4(later, radius));
    vec3 drift = since - framePath() + (v - frameVelocity()) * time;
    float most = ROOM_SHARE * abs(roomOf(reference));
    // A sphere in a listed pair asks for new lists once it has moved by the width of the strip: a pair that parts need
    // not stay listed.
    if (roomOf(reference) < 0.0f) most = min(most, strip());
    return dot3(drift, drift) > most * most;
}

// Asks for shorter substeps if the motion of the sphere is too large, and for new lists if it leaves its margin. `v` is
// its mean velocity in the substep, which ends at `to`.
void checkMotion(uint sphere, vec4 x, vec3 v, vec3 to) {
    vec4 reference = HAS(CONTACTS) ? listReference[sphere] : vec4(0.0f, 0.0f, 0.0f, 0.0f);
    float safe = SAFE_MOTION * radiusOf(x);
    if (dot3(v, v) * params.substep * params.substep > safe * safe) {
        float inverseOfMass = HAS(FIELDS) ? inverseMassOf(velocity[sphere]) : 0.0f;
        float motion = riskyMotion(withXyz(x, to), inverseOfMass, v, reference);
        if (motion > safe) atomicMax(counters[COUNTER_LARGEST_MOTION], floatBitsToUint(motion * SAFE_MOTION / safe));
    }
    if (!HAS(CONTACTS)) return;
    bool now = leavesLists(to, v, reference, storedRadius(x), 0.0f);
    if (now || leavesLists(to, v, reference, storedRadius(x), SOON_SUBSTEPS)) askForLists(now, HAS(PERIODIC) || roomOf(reference) != 0.0f);
}
