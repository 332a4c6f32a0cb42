// The model `balanced` while the lists have no room for all pairs: solves the contacts of all pairs of the cells
// (shared/contact_law.h). Contacts hold nothing. `phase` is the level and the colour of the bundles.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/grid.h"
#include "shared/bundles.h"

BUFFER(restrict, vec4, position)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(restrict, vec4, velocityBefore)
BUFFER(restrict, vec4, unheldVelocity)
BUFFER(restrict, vec4, unheldSpin)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(readonly, uint, cellStart)
BUFFER(restrict, uint, bundles)
BUFFER(readonly, uint, counters)
BUFFER(readonly, uint, cellOrder)
BUFFER(readonly, uint, isMover)

#include "shared/bundle_words.h"
#include "shared/contact.h"
#include "shared/friction.h"
#include "shared/contact_law.h"
#include "shared/wake.h"
#include "shared/contact_sums.h"

#define readHeldTorque()  // contacts hold nothing; with a function, glslang would need minutes
#include "shared/contact_pair.h"
#undef readHeldTorque

void visitPair(uint a, uint b) {
    heldImpulse = real3(0.0f, 0.0f, 0.0f);
    solvePairs(true, a, b, false);
}

#include "shared/visit_range.h"
#include "shared/group.h"

KERNEL(bundlesOfPhase()) {
    uint bundle = bundleOfPhase(invocation);
    if (hasList(bundle)) return;
    contactReach = 2.0f * fastestSpeed(bundle) * params.substep + SLOP * params.radius;
    if (HAS(CONTACT_SUMS)) beginContactSums();
    visitBundle(bundle, firstPair(bundle));
    if (HAS(CONTACT_SUMS)) endContactSums(bundle);
}
