// Sorts one column of the spheres: copies it to the scratch column in cell order. copy_vectors.comp copies it back.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(readonly, vec4, column)
BUFFER(readonly, uint, cellOrder)
BUFFER(writeonly, vec4, sortScratch)

KERNEL(params.spheres) {
    sortScratch[invocation] = column[cellOrder[invocation]];
}
