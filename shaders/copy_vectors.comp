// Copies a column back that sort_vectors.comp has sorted.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(readonly, vec4, sortScratch)
BUFFER(writeonly, vec4, column)

KERNEL(params.spheres) {
    column[invocation] = sortScratch[invocation];
}
