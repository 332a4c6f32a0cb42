// Prefix sum, middle pass: turns the few sums of the last level into exclusive prefix sums. `phase` is their number.
#include "shared/kernel.h"
#include "shared/layout.h"

BUFFER(restrict, uint, sums)

KERNEL(1u) {
    uint total = 0u;
    for (uint k = 0u; k < phase; ++k) {
        uint value = sums[k];
        sums[k] = total;
        total += value;
    }
}
