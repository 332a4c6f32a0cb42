// Puts a sphere to sleep that has stayed in one place for the sleep time, and is slow and carried now. Staying is told by
// its place, not by its speed in every substep: under load, the solver's pushes make it jitter about where it is. Slow
// and in place is not enough: so is every sphere at the top of its flight, if gravity is weak. Carried means that contacts
// took up at least half of gravity's pull in this substep. A spin about the normal of its only friction is slow to end:
// the longer a sphere has stayed, the faster it may turn. For one that falls asleep outside, there are new lists: it would
// no longer see that the frame moves away from it.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/outside.h"

BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(restrict, vec4, velocityBefore)  // w: s spent in one place
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
    // A sleeper has no velocity before the substep either: its neighbours bounce off what stands still.
    velocityBefore[invocation] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    velocity[invocation] = vec4(0.0f, 0.0f, 0.0f, -v.w);
    if (HAS(FRICTION)) angularVelocity[invocation] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
}
