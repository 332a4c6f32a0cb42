// Zeros the first `phase` words.
#include "shared/kernel.h"

BUFFER(0, writeonly, uint, words, WordBlock)

KERNEL(phase) {
    words[invocation] = 0u;
}
