// In scenes with contact sums, after the contacts of a substep have been solved: adds up the work of the contacts on the
// spheres, in parts of STATISTIC_BLOCK spheres. The work of an impulse is its product with the mean of the velocities
// before and after.
//
// `balanced`: the impulses of a substep act along with gravity and fields, from the velocity before the substep to the
// velocity after it. `accurate`: the forces act at the end of the motion. `fast`: impacts lie within the substep, and
// move the spheres too. The work is the change of kinetic and potential energy.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/fields.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, vec4, angularVelocity)
BUFFER(readonly, vec4, startPosition)
BUFFER(readonly, vec4, startVelocity)
BUFFER(readonly, vec4, startSpin)
BUFFER(restrict, float, workOfContacts)  // until the host takes it (J)

// The change of velocity in a substep without contacts, as begin_substep.comp adds it.
vec3 freeChange(uint sphere, vec3 v, float inverseMass) {
    vec3 change = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(GRAVITY)) change = vec3(params.gravity) * params.substep;
    if (HAS(FIELDS)) {
        vec4 x = startPosition[sphere];
        vec3 gravity = HAS(GRAVITY) ? vec3(params.gravity) : vec3(0.0f, 0.0f, 0.0f);
        change = meanAcceleration(gravity, vec3(x), v, radiusOf(x), inverseMass) * params.substep;
    }
    return change;
}

// The potential energy that a sphere gains on the way from one place to another (J/kg).
float potentialBetween(vec3 from, vec3 to, float radius, float inverseMass) {
    float gained = 0.0f;
    if (HAS(GRAVITY)) gained = -dot3(vec3(params.gravity), to - from);
    if (HAS(FIELDS)) gained += fieldPotential(to, radius, inverseMass) - fieldPotential(from, radius, inverseMass);
    return gained;
}

KERNEL(params.statisticBlocks) {
    uint end = min(params.spheres, (invocation + 1u) * STATISTIC_BLOCK);
    float work = 0.0f;
    for (uint k = invocation * STATISTIC_BLOCK; k < end; ++k) {
        vec4 v = velocity[k];
        if (!isAwake(v)) continue;
        vec3 start = vec3(startVelocity[k]);
        precise vec3 unheld = start;
        if (HAS(BALANCED)) unheld = start + freeChange(k, start, inverseMassOf(v));
        precise vec3 change = vec3(v) - unheld;
        float gained = 0.5f * dot3(change, vec3(v) + start);
        if (HAS(FRICTION)) {
            vec3 spin = vec3(angularVelocity[k]);
            vec3 startOfSpin = vec3(startSpin[k]);
            float radius = radiusOf(position[k]);
            gained += 0.2f * radius * radius * dot3(spin - startOfSpin, spin + startOfSpin);
        }
        if (HAS(FAST))
            gained += potentialBetween(vec3(startPosition[k]), vec3(position[k]), radiusOf(position[k]),
                                       inverseMassOf(v));
        gained = gained / inverseMassOf(v);
        // A state that is not finite is reported elsewhere.
        if (abs(gained) < 1.0e30f) work += gained;
    }
    workOfContacts[invocation] = workOfContacts[invocation] + work;
}
