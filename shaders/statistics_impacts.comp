// In an observed step, after the substep: adds up the speeds at which the pairs of each bundle that met approached and
// parted. `fast` and `balanced` resolve an impact within one substep. Bundles without lists are not observed.
// Approaches as slow as the weight of a pile causes are not observed either, because `fast` gives them no bounce.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/contact.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, vec4, velocityBeforeSolve)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uint, bundles)
BUFFER(readonly, uvec2, pairs)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(restrict, vec4, impacts)  // until the host takes them: impacts, sums of approach, parting, required parting

#include "shared/contact_params.h"

// The slowest approach that is observed, in multiples of params.deadBand.
#define WEIGHTLESS 10.0f

PRIVATE(vec4, sum)
SHARED(vec4, partialSums[BUNDLE_THREADS])

void visitPair(uint a, uint b) {
    // No speed along a direction exceeds the speed.
    vec3 relative = vec3(velocityBeforeSolve[b]) - vec3(velocityBeforeSolve[a]);
    float least = WEIGHTLESS * params.deadBand;
    if (!(dot3(relative, relative) > 0.999f * least * least)) return;
    vec4 pa = position[a];
    vec4 pb = position[b];
    vec3 d = separation(vec3(pa), vec3(pb));
    float squared = dot3(d, d);
    float reach = radiusSum(pa, pb) * (1.0f + TOUCH_TOLERANCE);
    if (!(squared < reach * reach)) {
        // Spheres fly on after an impact. Follows them back to the point where they parted.
        vec3 difference = vec3(velocity[a]) - vec3(velocity[b]);
        float along = dot3(d, difference);
        float root = along * along - dot3(difference, difference) * (squared - reach * reach);
        if (!(along > 0.0f) || !(root >= 0.0f)) return;
        float since = (squared - reach * reach) / (along + sqrt(root));
        if (!(since <= params.substep)) return;
        d = d - difference * since;
        squared = dot3(d, d);
    }
    vec3 n = vec3(normalAndDistance(d, squared, a, b));
    float approach = dot3(relative, n);
    if (!(approach > least)) return;
    float parting = dot3(vec3(velocity[a]) - vec3(velocity[b]), n);
    // A pair that still approaches as before has not met yet: it is only within the tolerance.
    if (!(parting > -0.5f * approach)) return;
    sum = sum + vec4(1.0f, approach, parting, restitutionOf(contactOf(a, b)) * approach);
}

#include "shared/bundle_words.h"

BUNDLE_KERNEL(params.bundles) {
    if (!hasList(invocation) || listedPairs(invocation) == 0u || (HAS(SLEEP) && !isActive(invocation))) return;
    // The sums have one order for any number of threads.
    for (uint part = THREAD; part < BUNDLE_THREADS; part += THREADS) {
        sum = vec4(0.0f, 0.0f, 0.0f, 0.0f);
        for (uint k = firstPair(invocation) + part; k < endOfPairs(invocation); k += BUNDLE_THREADS)
            visitPair(pairs[k].x, SECOND_OF(pairs[k]));
        partialSums[part] = sum;
    }
    BARRIER
    if (!FIRST_THREAD) return;
    sum = partialSums[0];
    for (uint part = 1u; part < BUNDLE_THREADS; ++part) sum = sum + partialSums[part];
    if (sum.x > 0.0f) impacts[invocation] = impacts[invocation] + sum;
}
