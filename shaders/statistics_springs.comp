// Adds up the energies of the springs between the spheres of each bundle, in the model `accurate`. It runs after
// statistics_contacts.comp and completes its rows. Bundles without lists are left out.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/contact.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, positionLow)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uint, bundles)
BUFFER(readonly, uvec2, pairs)
BUFFER(readonly, float, contactX)
BUFFER(readonly, float, contactY)
BUFFER(readonly, float, contactZ)
BUFFER(readonly, uint, counters)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(restrict, vec4, overlaps)

PRIVATE(vec3, displacement)

#include "shared/contact_params.h"
#include "shared/spring.h"

float energyOf(uint a, uint b) {
    vec4 pa = position[a];
    vec4 pb = position[b];
    vec3 d = separation(vec3(pa), vec3(pb));
    d = d + (vec3(positionLow[a]) - vec3(positionLow[b]));
    float squared = dot3(d, d);
    float ra = radiusOf(pa);
    float rb = radiusOf(pb);
    float reach = ra + rb;
    if (!(squared < reach * reach)) return 0.0f;
    vec4 normal = normalAndDistance(d, squared, a, b);
    float speed = dot3(vec3(velocity[a]) - vec3(velocity[b]), vec3(normal));
    return springEnergy(overlapWithSpeed(reach - distanceOf(normal), speed), ra * rb / reach, stiffnessOf(a, b),
                        displacement);
}

#include "shared/bundle_words.h"
#include "shared/contact_memory.h"

SHARED(float, partialSums[BUNDLE_THREADS])

BUNDLE_KERNEL(params.bundles) {
    if (!hasList(invocation) || listedPairs(invocation) == 0u) return;
    // The sums have one order for any number of threads.
    for (uint part = THREAD; part < BUNDLE_THREADS; part += THREADS) {
        float energy = 0.0f;
        for (uint k = firstPair(invocation) + part; k < endOfPairs(invocation); k += BUNDLE_THREADS) {
            uint at = presentHalf() + k;
            displacement = vec3(0.0f, 0.0f, 0.0f);
            if (HAS(FRICTION) && (pairs[k].y & PAIR_REMEMBERS) != 0u)
                displacement = vec3(contactX[at], contactY[at], contactZ[at]);
            energy += energyOf(pairs[k].x, SECOND_OF(pairs[k]));
        }
        partialSums[part] = energy;
    }
    BARRIER
    if (!FIRST_THREAD) return;
    float energy = 0.0f;
    for (uint part = 0u; part < BUNDLE_THREADS; ++part) energy += partialSums[part];
    vec4 row = overlaps[invocation];
    overlaps[invocation] = vec4(row.x, row.y, row.z, energy);
}
