// Friction of the touching pairs, after all normal speeds are settled. Until then, the slip of a pair contains the
// incomplete sum of its neighbours' impulses. Coulomb's limit follows from the whole normal impulse of the substep.
// `phase` is the level and the colour of the groups.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/contact.h"
#include "shared/friction.h"

BUFFER(readonly, vec4, position)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uvec4, groupRange)
BUFFER(readonly, uvec2, touching)
BUFFER(readonly, float, normalImpulses)
BUFFER(readonly, ContactParams, contactParams)

#include "shared/contact_params.h"
#include "shared/friction_pair.h"

KERNEL(groupsOfPhase()) {
    uvec4 range = groupRange[groupOfPhase(invocation)];
    if (HAS(SLEEP) && !isActive(range)) return;
    // Groups without lists store no impulses: they have no friction.
    if (!hasList(range)) return;
    for (uint k = firstPair(range); k < firstPair(range) + touchingPairs(range); ++k) {
        float normalImpulse = normalImpulses[k];
        if (!(normalImpulse > 0.0f)) continue;
        uint a = touching[k].x;
        uint b = touching[k].y;
        vec4 pa = position[a];
        vec4 pb = position[b];
        vec3 d = vec3(pa) - vec3(pb);
        vec3 n = vec3(normalAndDistance(d, dot3(d, d), a, b));
        applyPairFriction(a, b, n, radiusOf(pa), radiusOf(pb), normalImpulse,
                contactOf(a, b));
    }
}
