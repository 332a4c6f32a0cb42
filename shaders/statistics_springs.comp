// Adds up the energies of the springs between the spheres of each group, in the model `accurate`. It runs after
// statistics_contacts.comp and completes its rows. Groups without lists are left out.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/contact.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, positionLow)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uvec4, groupRange)
BUFFER(readonly, uvec2, pairs)
BUFFER(readonly, vec4, tangentialSlip)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(restrict, vec4, overlaps)

PRIVATE(vec3, displacement)

#include "shared/contact_params.h"
#include "shared/spring.h"

float energyOf(uint a, uint b) {
    vec4 pa = position[a];
    vec4 pb = position[b];
    vec3 d = vec3(pa) - vec3(pb);
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

KERNEL(params.groups * 8u) {
    uvec4 range = groupRange[invocation];
    if (!hasList(range)) return;
    float energy = 0.0f;
    displacement = vec3(0.0f, 0.0f, 0.0f);
    for (uint k = firstPair(range); k < firstPair(range) + listedPairs(range); ++k) {
        uvec2 pair = pairs[k];
        if (HAS(FRICTION)) displacement = vec3(tangentialSlip[k]);
        energy += energyOf(pair.x, pair.y);
    }
    vec4 row = overlaps[invocation];
    overlaps[invocation] = vec4(row.x, row.y, row.z, energy);
}
