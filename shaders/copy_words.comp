// Copies a column back that sort_words.comp has sorted.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(readonly, uint, sortScratchWords)
BUFFER(writeonly, uint, column)

KERNEL(params.spheres) {
    column[invocation] = sortScratchWords[invocation];
}
