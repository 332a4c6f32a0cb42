// Puts a sphere to sleep if it has stayed in one place for the sleep time, and if it is slow and carried now.
//
// A sphere stays in one place if it neither moves away nor reaches the wake speed. It need not be slow in every
// substep: under load, the solver's pushes make it jitter in place.
//
// A slow sphere in one place may also be at the top of its flight in weak gravity. A sphere therefore counts as carried
// only if contacts took up at least half of gravity's pull in this substep.
//
// A spin about the normal of a sphere's only contact with friction takes long to end. The longer a sphere has stayed,
// the faster it may therefore turn. A sphere that falls asleep outside the bounds asks for new lists, because it would
// not notice that the frame moves away from it.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/outside.h"

BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(restrict, vec4, velocityBefore)  // w: time spent in one place (s), or MOVED_AWAY
BUFFER(readonly, vec4, position)
BUFFER(coherent, uint, counters)

KERNEL(params.spheres) {
    vec4 v = velocity[invocation];
    if (v.w < 0.0f) return;
    vec4 u = velocityBefore[invocation];
    float squared = dot3(vec3(v), vec3(v));
    float spent = squared < params.wakeSpeed * params.wakeSpeed ? max(u.w, 0.0f) + params.substep : 0.0f;
    bool asleep = spent >= params.sleepTime && squared < params.sleepSpeed * params.sleepSpeed;
    if (HAS(GRAVITY)) {
        vec3 pull = vec3(params.gravity) * params.substep;
        vec3 carried = vec3(v) - vec3(u) - pull;
        asleep = asleep && dot3(carried, carried) > 0.25f * dot3(pull, pull);
    }
    if (HAS(FRICTION)) {
        vec3 spin = vec3(angularVelocity[invocation]) *
                    (HAS(RADII) ? position[invocation].w : params.radius);
        float omega = params.sleepSpeed * min(spent / params.sleepTime, 4.0f);
        asleep = asleep && dot3(spin, spin) < omega * omega;
    }
    if (!asleep) {
        velocityBefore[invocation] = vec4(vec3(u), spent);
        return;
    }
    if (beyond(vec3(position[invocation])) > 0.0f) atomicOr(counters[COUNTER_REBUILD], 1u);
    // The velocity before the substep is zero too: neighbours bounce off a sphere at rest.
    velocityBefore[invocation] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    velocity[invocation] = vec4(0.0f, 0.0f, 0.0f, -v.w);
    if (HAS(FRICTION)) angularVelocity[invocation] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
}
