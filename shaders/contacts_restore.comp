// After the lists are rebuilt: copies what each contact remembers to its place in the new lists.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uint, bundles)
BUFFER(restrict, uvec2, pairs)
BUFFER(restrict, float, contactX)
BUFFER(restrict, float, contactY)
BUFFER(restrict, float, contactZ)
BUFFER(restrict, float, torqueX)
BUFFER(restrict, float, torqueY)
BUFFER(restrict, float, torqueZ)
BUFFER(coherent, uint, counters)
BUFFER(readonly, uint, carriedCount)
BUFFER(readonly, uvec2, carried)

#include "shared/bundle_words.h"
#include "shared/carried.h"
#include "shared/contact_memory.h"
#include "shared/contact_owner.h"
#include "shared/movers.h"

// The rows of `carried` are prefetched for the pair that comes this many pairs later.
#define PAIRS_AHEAD 16u

PRIVATE(uint, restored)

// Copies the memory of a contact from the old lists. `sign` is -1 if its spheres have changed places.
void restore(uint to, uint from, float sign) {
    restored = restored + 1u;
    contactX[to] = sign * contactX[from];
    contactY[to] = sign * contactY[from];
    contactZ[to] = sign * contactZ[from];
    if (HAS(BALANCED) && HAS(FRICTION)) {
        torqueX[to] = torqueX[from];
        torqueY[to] = torqueY[from];
        torqueZ[to] = torqueZ[from];
    }
}

// For the prefetch. In GLSL, another thread may have set PAIR_REMEMBERS already.
uint ownerOf(uint pair) {
    uint a = pairs[pair].x;
    uint b = SECOND_OF(pairs[pair]);
    return idOf(idAndMaterial[firstOwnsContact(a, b) ? a : b]);
}

BUNDLE_KERNEL(params.bundles) {
    uint bundle = invocation;
    if (bundle < firstBuiltBundle() || !hasList(bundle) || listedPairs(bundle) == 0u) return;
    uint present = presentHalf();
    // The pairs of movers have other numbers than before, so that they may stay in the same half.
    uint previous = moversAlone() ? present : previousHalf();
    restored = 0u;
    for (uint k = firstPair(bundle) + THREAD; k < endOfPairs(bundle); k += THREADS) {
        PREFETCH(carried[ownerOf(min(k + PAIRS_AHEAD, endOfPairs(bundle) - 1u)) * CARRIED_MOST])
        uint a = pairs[k].x;
        uint b = pairs[k].y;  // it has no PAIR_REMEMBERS yet
        bool first = firstOwnsContact(a, b);
        uint owner = idOf(idAndMaterial[first ? a : b]);
        uint count = carriedBy(owner);
        if (count == 0u) continue;
        uint partner = partnerWord(idOf(idAndMaterial[first ? b : a]));
        for (uint place = owner * CARRIED_MOST; place < owner * CARRIED_MOST + count; ++place) {
            uvec2 one = carried[place];
            if ((one.x & ~FIRST_OWNS) != partner) continue;
            restore(present + k, previous + one.y, first == (one.x >= FIRST_OWNS) ? 1.0f : -1.0f);
            pairs[k].y = b | PAIR_REMEMBERS;
            break;
        }
    }
    if (restored > 0u) atomicAdd(counters[COUNTER_RESTORED], restored);
}
