// Puts a sphere to sleep that has been slow, and carried, for the sleep time. Slow alone is not enough: at the top of its
// flight every sphere is slow. Carried means that contacts took up at least half of gravity's pull in this substep.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"

BUFFER(0, restrict, vec4, velocity, VelocityBlock)
BUFFER(1, restrict, vec4, before, BeforeBlock)  // w: s spent quiet

KERNEL(params.spheres) {
    vec4 v = velocity[invocation];
    if (v.w < 0.0f) return;
    vec4 u = before[invocation];
    bool quiet = dot3(vec3(v), vec3(v)) < params.sleepSpeed * params.sleepSpeed;
    if (HAS(GRAVITY)) {
        vec3 pull = vec3(params.gravity) * params.substep;
        vec3 carried = vec3(v) - vec3(u) - pull;
        quiet = quiet && dot3(carried, carried) > 0.25f * dot3(pull, pull);
    }
    float spent = quiet ? max(u.w, 0.0f) + params.substep : 0.0f;
    bool asleep = spent >= params.sleepTime;
    // A sleeper has no velocity before the substep either: its neighbours bounce off what stands still.
    before[invocation] = asleep ? vec4(0.0f, 0.0f, 0.0f, 0.0f) : vec4(vec3(u), spent);
    if (asleep) velocity[invocation] = vec4(0.0f, 0.0f, 0.0f, -v.w);
}
