// Before the lists are rebuilt: flags the sleepers with a neighbour that leaves so fast that it is out of reach after
// this one substep. The new lists do not hold such a pair, but the old ones do. The kernel runs over all groups at
// once, so it only raises flags. wake_flagged.comp wakes the spheres.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/wake.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, vec4, velocityBefore)
BUFFER(readonly, uint, cellStart)
BUFFER(readonly, uvec4, groupRange)
BUFFER(readonly, uvec2, pairs)
BUFFER(coherent, uint, wakeFlags)

// Flags the sleeper if the mover was within its wake gap when the substep began.
void flagIfLeft(uint sleeper, uint mover) {
    vec4 u = velocityBefore[mover];
    if (!canWake(u)) return;
    vec4 pa = position[sleeper];
    vec4 pb = position[mover];
    vec3 d = vec3(pb) - vec3(u) * params.substep - vec3(pa);
    float wakeReach = radiusSum(pa, pb) + wakeGap();
    if (dot3(d, d) < wakeReach * wakeReach) atomicOr(wakeFlags[sleeper], 1u);
}

void visitPair(uint a, uint b) {
    bool aSleeps = isAsleep(velocity[a]);
    bool bSleeps = isAsleep(velocity[b]);
    if (aSleeps == bSleeps) return;
    flagIfLeft(aSleeps ? a : b, aSleeps ? b : a);
}

#include "shared/group.h"

KERNEL(params.groups * 8u) {
    uvec4 range = groupRange[invocation];
    if (!hasList(range)) {
        visitGroupNumber(invocation, unlistedRound(range));
        return;
    }
    for (uint k = firstPair(range); k < firstPair(range) + listedPairs(range); ++k) visitPair(pairs[k].x, pairs[k].y);
}
