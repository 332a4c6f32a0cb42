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
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/outside.h"

BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(restrict, vec4, velocityBefore)  // w: time spent in one place (s), or MOVED_AWAY
BUFFER(readonly, vec4, position)
BUFFER(coherent, uint, counters)

KERNEL(params.spheres) {
    vec4 v = velocity[invocation];
    if (isAsleep(v)) return;
    vec4 u = velocityBefore[invocation];
    float squared = dot3(vec3(v), vec3(v));
    float quietTime = squared < params.wakeSpeed * params.wakeSpeed ? max(quietTimeOf(u), 0.0f) + params.substep : 0.0f;
    bool fallsAsleep = quietTime >= params.sleepTime && squared < params.sleepSpeed * params.sleepSpeed;
    if (HAS(GRAVITY)) {
        vec3 pull = vec3(params.gravity) * params.substep;
        vec3 contactChange = vec3(v) - vec3(u) - pull;
        fallsAsleep = fallsAsleep && dot3(contactChange, contactChange) > 0.25f * dot3(pull, pull);
    }
    if (HAS(FRICTION)) {
        vec3 spin = vec3(angularVelocity[invocation]) *
                    radiusOf(position[invocation]);
        float maxSpin = params.sleepSpeed * min(quietTime / params.sleepTime, 4.0f);
        fallsAsleep = fallsAsleep && dot3(spin, spin) < maxSpin * maxSpin;
    }
    if (!fallsAsleep) {
        velocityBefore[invocation] = vec4(vec3(u), quietTime);
        return;
    }
    if (beyond(vec3(position[invocation])) > 0.0f) atomicOr(counters[COUNTER_REBUILD], 1u);
    // The velocity before the substep is zero too: neighbours bounce off a sphere at rest.
    velocityBefore[invocation] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    velocity[invocation] = sleepToggled(withXyz(v, vec3(0.0f, 0.0f, 0.0f)));
    if (HAS(FRICTION)) angularVelocity[invocation] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
}
