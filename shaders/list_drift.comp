// Sets the drift of new lists: the middle of the box of all velocities, or 0 if a sphere sleeps or is
// fixed.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/ordered_key.h"

BUFFER(coherent, uint, counters)

#include "shared/movers.h"

KERNEL(1u) {
    if (moversAlone()) {
        counters[COUNTER_MOVERS_ALONE] = LISTS_BUILT;
        return;
    }
    counters[COUNTER_RESTING] = counters[COUNTER_RESTING] & RESTS;
    for (uint axis = 0u; axis < 3u; ++axis) {
        uint high = counters[COUNTER_DRIFT_BOX + axis];
        uint low = counters[COUNTER_DRIFT_BOX + 3u + axis];
        bool moves = high != 0u && counters[COUNTER_RESTING] == 0u;
        counters[COUNTER_DRIFT + axis] = floatBitsToUint(moves ? 0.5f * (ofKey(high) - ofKey(low)) : 0.0f);
    }
}
