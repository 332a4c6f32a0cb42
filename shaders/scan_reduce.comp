// Prefix sum, first pass: adds up blocks of SCAN_BLOCK values. `phase` is the number of values.
#include "shared/kernel.h"
#include "shared/layout.h"

BUFFER(readonly, uint, values)
BUFFER(writeonly, uint, sums)

KERNEL((phase + SCAN_BLOCK - 1u) / SCAN_BLOCK) {
    uint end = min(phase, (invocation + 1u) * SCAN_BLOCK);
    uint sum = 0u;
    for (uint k = invocation * SCAN_BLOCK; k < end; ++k) sum += values[k];
    sums[invocation] = sum;
}
