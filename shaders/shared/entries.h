// The slots of entries (shared/movers.h). The includer binds `counters`, `cellOrder` and `isMover`, or defines NO_MOVERS
// if it belongs to no scene with movers.
#ifdef NO_MOVERS
uint slotOfEntry(uint entry) {
    return entry;
}

bool isOldEntry(uint a, uint b) {
    return false;
}
#else
#include "shared/movers.h"

bool isEntryOfMover(uint entry) {
    return HAS(MOVERS) && entry >= counters[COUNTER_SORTED];
}

uint slotOfEntry(uint entry) {
    return isEntryOfMover(entry) ? cellOrder[entry] : entry;
}

// Returns true if entry `b` is the old one of a sphere that is a mover, beside the mover of entry `a`.
bool isOldEntry(uint a, uint b) {
    return isEntryOfMover(a) && !isEntryOfMover(b) && isMover[b] != 0u;
}
#endif
