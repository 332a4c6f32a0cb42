// Sets the counts of the cells to 0, and one more: the end of the last cell.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(writeonly, uint, cellStart)
BUFFER(readonly, uint, counters)

#include "shared/movers.h"

KERNEL(allCells() + 1u) {
    uint cell = firstBuiltCell() + invocation;
    if (cell <= allCells()) cellStart[cell] = 0u;
}
