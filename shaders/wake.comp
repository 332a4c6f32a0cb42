// Wakes the sleepers with a neighbour that comes or leaves. Runs before the contacts are solved, and also before the
// lists are rebuilt: the new lists do not hold a neighbour that has left within one substep. `phase` is the level and
// the colour of the bundles, with LEAVERS before a rebuild.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/grid.h"
#include "shared/bundles.h"
#include "shared/wake.h"

BUFFER(readonly, vec4, position)
BUFFER(coherent, vec4, velocity)
BUFFER(readonly, vec4, restReference)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uint, cellStart)
BUFFER(readonly, uint, bundles)
BUFFER(readonly, uvec2, pairs)
BUFFER(readonly, uint, counters)
BUFFER(readonly, uint, cellOrder)
BUFFER(readonly, uint, isMover)
BUFFER(readonly, uint, leftBlock)

#include "shared/bundle_words.h"

// Wakes the sleeper if the mover is, or was or will be within a substep, within its wake gap.
void wakeBy(uint sleeper, uint mover) {
    vec4 v = velocity[mover];
    if (!canWake(v, restReference[idOf(idAndMaterial[mover])])) return;
    vec4 pa = position[sleeper];
    vec4 pb = position[mover];
    vec3 d = separation(vec3(pa), vec3(pb));
    float reach = radiusSum(pa, pb) + wakeGap() + sqrt(dot3(vec3(v), vec3(v))) * params.substep;
    if (dot3(d, d) < reach * reach) velocity[sleeper] = sleepToggled(velocity[sleeper]);
}

void visitPair(uint a, uint b) {
    bool aSleeps = isAsleep(velocity[a]);
    bool bSleeps = isAsleep(velocity[b]);
    if (aSleeps == bSleeps) return;
    wakeBy(aSleeps ? a : b, aSleeps ? b : a);
}

#include "shared/visit_range.h"
#include "shared/group.h"
#include "shared/left_block.h"

bool beginBundle(uint bundle) {
    if (counters[COUNTER_RESTING] == 0u || !isActive(bundle)) return false;
    // Before a rebuild, `active` is of the substep before. Only lists that change can lose a pair.
    bool leavers = (phase & LEAVERS) != 0u;
    if (!leavers && !hasWakers(bundle)) return false;
    if (leavers && moversAlone() && bundle < firstBuiltBundle() && !wasLeft(bundle)) return false;
    if (hasList(bundle)) return listedPairs(bundle) > 0u;
    if (FIRST_THREAD) visitBundle(bundle, firstPair(bundle));
    return false;
}

void endBundle(uint bundle) {
}

void visitPairs(uint a, uint b, uint at) {
    visitPair(a, SLOTS_OF(b));
}

PAIR_KERNEL
