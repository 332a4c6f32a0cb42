// Sets the counts of all cells to 0, and one more: the end of the last cell.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(writeonly, uint, cellStart)

KERNEL(params.cells.w + 1u) {
    cellStart[invocation] = 0u;
}
