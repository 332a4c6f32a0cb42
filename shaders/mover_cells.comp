// Before lists of movers alone are built: turns the counts of their cells into the first entries of the cells.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(readonly, uint, counters)
BUFFER(coherent, uint, cellStart)

SHARED(uint, sums[THREADS])  // of the counts of each thread, then the entries before them

BUNDLE_KERNEL(1u) {
    uint first = params.firstMoverCell;
    uint cells = allCells() + 1u - first;  // with the end of the last one
    uint share = (cells + THREADS - 1u) / THREADS;
    uint begin = first + min(THREAD * share, cells);
    uint end = first + min((THREAD + 1u) * share, cells);
    uint sum = 0u;
    for (uint cell = begin; cell < end; ++cell) sum = sum + cellStart[cell];
    sums[THREAD] = sum;
    BARRIER
    if (FIRST_THREAD) {
        uint total = counters[COUNTER_SORTED];
        for (uint k = 0u; k < THREADS; ++k) {
            uint count = sums[k];
            sums[k] = total;
            total = total + count;
        }
    }
    BARRIER
    uint entry = sums[THREAD];
    for (uint cell = begin; cell < end; ++cell) {
        uint count = cellStart[cell];
        cellStart[cell] = entry;
        entry = entry + count;
    }
}
