// Sets the counts of all cells to 0, and one more: the end of the last cell.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(writeonly, uint, cellStart)

KERNEL(allCells() + 1u) {
    cellStart[invocation] = 0u;
}
