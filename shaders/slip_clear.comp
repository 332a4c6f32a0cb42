// Empties the owners' counts. One more than there are spheres, for the end of the last one.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(writeonly, uint, carriedOffsets)

KERNEL(params.spheres + 1u) {
    carriedOffsets[invocation] = 0u;
}
