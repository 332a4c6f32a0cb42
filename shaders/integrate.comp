// Moves each awake sphere along its ballistic arc, exactly: v += g h, x += v h - g h^2 / 2. Never derives a velocity
// from positions, because float32 positions are too coarse for it. Asks for new pair lists when a sphere has left its
// margin.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/id_and_material.h"
#include "shared/outside.h"

BUFFER(restrict, vec4, position)
BUFFER(restrict, vec4, positionLow)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, velocityBefore)
BUFFER(readonly, vec4, listReference)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(coherent, uint, counters)
BUFFER(restrict, vec4, restReference)
BUFFER(readonly, Obstacle, obstacles)

#include "shared/falling_frame.h"

// The time, in steps, that a sphere looks ahead. Substeps are fitted after each step to the motions in it, so that a
// sphere must see all that it may meet within two steps.
#define LOOK_AHEAD 2.0f

PRIVATE(vec3, wallPoint)
PRIVATE(vec3, flight)  // velocity of the sphere that looks ahead (m/s)
PRIVATE(float, reach)  // its radius plus the distance that it looks ahead (m)
PRIVATE(float, own)    // its radius (m)
PRIVATE(bool, meets)

// Returns true if the sphere may close the gap while it looks ahead, and if the substeps are too long for the impact.
bool closes(float gap, vec3 normal) {
    float ahead = LOOK_AHEAD * params.step;
    float speed = -dot3(flight, normal);
    if (HAS(GRAVITY)) speed = speed + max(-dot3(vec3(params.gravity), normal), 0.0f) * ahead;
    return speed * ahead > gap && speed * params.substep > FAR_MOTION * own;
}

void visitWall(vec3 normal, float depth, uint wallMaterial, uint surface) {
    meets = meets || closes(reach - own - depth, normal);
}

#include "shared/walls.h"

// Returns true if a sphere outside may soon meet a wall, an obstacle or a sphere inside the bounds.
bool comesTo(vec3 p, vec3 v, float radius) {
    float ahead = LOOK_AHEAD * params.step;
    float speed = sqrt(dot3(v, v));
    if (HAS(GRAVITY)) speed = speed + sqrt(dot3(vec3(params.gravity), vec3(params.gravity))) * ahead;
    wallPoint = p;
    flight = v;
    own = radius;
    reach = radius + speed * ahead;
    meets = false;
    if (HAS(CONTACTS)) {
        vec3 nearest = vec3(min(max(p.x, params.wallMin.x), params.wallMax.x),
                            min(max(p.y, params.wallMin.y), params.wallMax.y),
                            min(max(p.z, params.wallMin.z), params.wallMax.z));
        vec3 d = p - nearest;
        float distance = sqrt(dot3(d, d));
        meets = distance <= strip() || closes(distance - strip(), d * (1.0f / distance));
    }
    visitWalls(reach);
    return meets;
}

// The motion of the sphere in a substep (m), as far as it may carry the sphere past an object that it should hit.
// `start` is its row of `listReference`.
float riskyMotion(vec4 sphere, vec3 v, vec4 start) {
    float h = params.substep;
    float motion = sqrt(dot3(v, v) * h * h);
    vec3 p = vec3(sphere);
    if (!(beyond(p) > 0.0f) || comesTo(p, v, HAS(RADII) ? sphere.w : params.radius)) return motion;
    if (!HAS(CONTACTS) || start.w >= UNLIMITED_ROOM || counters[COUNTER_REBUILDS] == 0u) return 0.0f;
    // Among spheres outside, only its motion relative to their frame counts.
    vec3 drift = v - frameVelocity();
    float speed = sqrt(dot3(drift, drift));
    vec3 since = p - vec3(start) - framePath();
    float used = sqrt(dot3(since, since)) + speed * LOOK_AHEAD * params.step;
    return start.w > 0.0f && used < 0.5f * start.w ? 0.0f : speed * h;
}

// Returns true if the lists may lack a pair of this sphere, which has moved to `to`.
bool leavesLists(vec3 to, vec4 start, float radius) {
    vec3 since = to - vec3(start);
    bool far = dot3(since, since) > params.rebuildMove * params.rebuildMove;
    if (start.w == 0.0f) return far;
    if (far && !(beyondStrip(to) && beyondStrip(vec3(start)))) return true;
    if (lost(vec4(vec3(start), radius))) return !lost(vec4(to, radius));
    vec3 drift = since - framePath();
    float most = ROOM_SHARE * abs(start.w);
    // A sphere in a listed pair asks for new lists once it has moved by the width of the strip: a pair that parts need
    // not stay listed.
    if (start.w < 0.0f) most = min(most, strip());
    return dot3(drift, drift) > most * most;
}

KERNEL(params.spheres) {
    vec4 v = velocity[invocation];
    if (HAS(SLEEP) && v.w < 0.0f) return;
    vec4 x = position[invocation];
    if (farthestAxis(vec3(x)) > LAST_PLACE && finite3(vec3(x))) return;
    float h = params.substep;
    if (HAS(VELOCITY_BEFORE)) velocityBefore[invocation] = vec4(vec3(v), velocityBefore[invocation].w);
    vec3 moved = vec3(v);
    if (HAS(GRAVITY)) {
        vec3 kick = vec3(params.gravity) * h;
        moved = moved + kick;
        velocity[invocation] = vec4(moved, v.w);
        moved = moved - kick * 0.5f;
    }
    precise vec3 to = vec3(x) + moved * h;
    if (HAS(LOW_BITS)) {
        // Adds the residual of the position beyond float32. Without it, short substeps would not move a slow sphere at
        // all.
        vec4 residual = positionLow[invocation];
        precise vec3 low = vec3(residual) + moved * h;
        to = vec3(x) + low;
        precise vec3 held = to - vec3(x);
        positionLow[invocation] = vec4(low - held, residual.w);
    }
    position[invocation] = vec4(to, x.w);
    if (!finite3(to)) {
        // The sphere is counted and reported. It touches nothing, because comparisons with its position are false.
        atomicAdd(counters[COUNTER_NON_FINITE], 1u);
        atomicMax(counters[COUNTER_FIRST_ID], ~idOf(idAndMaterial[invocation]));
        return;
    }
    vec4 start = HAS(CONTACTS) ? listReference[invocation] : vec4(0.0f, 0.0f, 0.0f, 0.0f);
    float far = FAR_MOTION * (HAS(RADII) ? x.w : params.radius);
    if (dot3(moved, moved) * h * h > far * far) {
        float motion = riskyMotion(vec4(to, x.w), moved, start);
        if (motion > far) atomicMax(counters[COUNTER_FASTEST], floatBitsToUint(motion * FAR_MOTION / far));
    }
    if (HAS(CONTACTS)) {
        if (leavesLists(to, start, x.w)) atomicOr(counters[COUNTER_REBUILD], 1u);
        // Does not use `listReference`, which is reset whenever any sphere needs new lists: a slow sphere would then
        // never have moved away.
        if (HAS(SLEEP)) {
            uint id = idOf(idAndMaterial[invocation]);
            vec3 crept = to - vec3(restReference[id]);
            if (dot3(crept, crept) > params.creep * params.creep) {
                restReference[id] = vec4(to, 0.0f);
                velocityBefore[invocation] = vec4(vec3(v), MOVED_AWAY);
            }
        }
    }
}
