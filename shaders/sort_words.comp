// Sorts one column of the spheres: copies it to the scratch column in cell order. copy_words.comp copies it back.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(readonly, uint, column)
BUFFER(readonly, uint, cellOrder)
BUFFER(writeonly, uint, sortScratchWords)

KERNEL(params.spheres) {
    sortScratchWords[invocation] = column[cellOrder[invocation]];
}
