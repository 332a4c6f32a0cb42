// Sets the counts of all owners to 0, and one more: the end of the last owner's contacts.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(writeonly, uint, carriedOffsets)

KERNEL(params.spheres + 1u) {
    carriedOffsets[invocation] = 0u;
}
