// Prefix sum, last pass: turns values into exclusive prefix sums, block by block. `phase` is the number of values.
#include "shared/kernel.h"
#include "shared/layout.h"

BUFFER(restrict, uint, values)
BUFFER(readonly, uint, sums)

KERNEL((phase + SCAN_BLOCK - 1u) / SCAN_BLOCK) {
    uint end = min(phase, (invocation + 1u) * SCAN_BLOCK);
    uint total = sums[invocation];
    for (uint k = invocation * SCAN_BLOCK; k < end; ++k) {
        uint value = values[k];
        values[k] = total;
        total += value;
    }
}
