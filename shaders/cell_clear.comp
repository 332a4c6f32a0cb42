// Empties the cells. One more than there are, for the end of the last one.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(writeonly, uint, cellStart)

KERNEL(params.cells.w + 1u) {
    cellStart[invocation] = 0u;
}
