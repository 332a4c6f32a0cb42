// Sorts the spheres of each cell by id, because the scatter leaves them in the device's order of execution. It uses
// heap sort, so that a crowded cell of n spheres costs n log n.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"

BUFFER(readonly, uint, cellStart)
BUFFER(restrict, uint, cellOrder)
BUFFER(readonly, uint, idAndMaterial)

// Restores the heap below `root` in cellOrder[first .. first + count - 1].
void sink(uint first, uint root, uint count) {
    uint moving = cellOrder[first + root];
    uint key = idOf(idAndMaterial[moving]);
    uint hole = root;
    for (uint child = 2u * hole + 1u; child < count; child = 2u * hole + 1u) {
        if (child + 1u < count &&
            idOf(idAndMaterial[cellOrder[first + child + 1u]]) > idOf(idAndMaterial[cellOrder[first + child]]))
            child = child + 1u;
        if (idOf(idAndMaterial[cellOrder[first + child]]) <= key) break;
        cellOrder[first + hole] = cellOrder[first + child];
        hole = child;
    }
    cellOrder[first + hole] = moving;
}

KERNEL(allCells()) {
    uint first = cellStart[invocation];
    uint count = cellStart[invocation + 1u] - first;
    if (count < 2u) return;
    for (uint root = count / 2u; root > 0u; --root) sink(first, root - 1u, count);
    for (uint end = count - 1u; end > 0u; --end) {
        uint top = cellOrder[first];
        cellOrder[first] = cellOrder[first + end];
        cellOrder[first + end] = top;
        sink(first, 0u, end);
    }
}
