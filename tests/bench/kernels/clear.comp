// Zeros the first `phase` words.
#include "shared/kernel.h"

BUFFER(writeonly, uint, words)

KERNEL(phase) {
    words[invocation] = 0u;
}
