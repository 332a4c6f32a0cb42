// Empties the owners' counts. One more than there are spheres, for the end of the last one.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(0, writeonly, uint, keptStart, KeptStartBlock)

KERNEL(params.spheres + 1u) {
    keptStart[invocation] = 0u;
}
