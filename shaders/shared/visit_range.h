// Visits the pairs of an entry with a range of entries one by one, for shared/group.h. The includer has defined
// `void visitPair(uint a, uint b)`, which gets slots, and binds `counters`, `cellOrder` and `isMover`.
#include "shared/entries.h"

void visitRange(uint a, uint b, uint end) {
    for (; b < end; ++b)
        if (!isOldEntry(a, b)) visitPair(slotOfEntry(a), slotOfEntry(b));
}
