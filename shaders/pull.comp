// Pulls spheres to points by springs with critical damping, at the beginning of a substep. Implicit, so that it is
// stable for every stiffness. The pull and the speed that it gives are limited; the damping only takes energy.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/fields.h"

BUFFER(readonly, vec4, pulls)
BUFFER(readonly, uint, slotOf)
BUFFER(readonly, vec4, position)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, unheldVelocity)
BUFFER(restrict, vec4, restReference)

// A row of `restReference` of a sphere that does not come to rest.
vec4 restless(vec4 rest) {
    return vec4(vec3(rest), hasMovedAway(rest) ? MOVED_AWAY : 0.0f);
}

vec3 limited(vec3 a, float most) {
    float square = dot3(a, a);
    return square > most * most ? a * (most / sqrt(square)) : a;
}

KERNEL(MOST_PULLS) {
    vec4 point = pulls[PULL_ROWS * invocation];
    vec4 limits = pulls[PULL_ROWS * invocation + 1u];
    float rate = point.w;
    if (rate == 0.0f) return;
    uint id = uint(limits.z);
    uint sphere = slotOf[id];
    vec4 x = position[sphere];
    vec4 v = velocity[sphere];
    if (!finite3(vec3(x)) || !finite3(vec3(v))) return;
    float h = params.substep;
    vec3 fall = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(GRAVITY)) fall = vec3(params.gravity);
    if (HAS(FIELDS)) fall = meanAcceleration(fall, vec3(x), vec3(v), radiusOf(x), inverseMassOf(v));
    // The mean velocity on the path of this substep without the spring: the damping acts on it, so that a sphere that
    // hangs at rest is not damped.
    vec3 kick = fall * (0.5f * h);
    vec3 mean = vec3(v) + kick;
    float share = 1.0f / ((1.0f + h * rate) * (1.0f + h * rate));
    vec3 given = limited(separation(vec3(point), vec3(x)) * (h * rate * rate * share), limits.x * h);
    vec3 pulled = limited(mean * share + given, max(limits.y, sqrt(dot3(mean, mean))));
    vec3 to = pulled - kick;
    velocity[sphere] = vec4(to, abs(v.w));
    if (HAS(BALANCED)) {  // what it holds stays
        vec4 unheld = unheldVelocity[sphere];
        unheldVelocity[sphere] = withXyz(unheld, vec3(unheld) + (to - vec3(v)));
    }
    if (HAS(SLEEP)) restReference[id] = restless(restReference[id]);
}
