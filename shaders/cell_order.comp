// Puts the spheres of a cell in id order: the scatter left them in the order in which the device happened to run. Heap
// sort, so that a crowded cell costs n log n.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/label.h"

BUFFER(0, readonly, uint, cellStart, CellBlock)
BUFFER(1, restrict, uint, order, OrderBlock)
BUFFER(2, readonly, uint, label, LabelBlock)

// Restores the heap below `root` in order[first .. first + count - 1].
void sink(uint first, uint root, uint count) {
    uint moving = order[first + root];
    uint key = idOf(label[moving]);
    uint hole = root;
    for (uint child = 2u * hole + 1u; child < count; child = 2u * hole + 1u) {
        if (child + 1u < count && idOf(label[order[first + child + 1u]]) > idOf(label[order[first + child]]))
            child = child + 1u;
        if (idOf(label[order[first + child]]) <= key) break;
        order[first + hole] = order[first + child];
        hole = child;
    }
    order[first + hole] = moving;
}

KERNEL(params.cells.w) {
    uint first = cellStart[invocation];
    uint count = cellStart[invocation + 1u] - first;
    if (count < 2u) return;
    for (uint root = count / 2u; root > 0u; --root) sink(first, root - 1u, count);
    for (uint end = count - 1u; end > 0u; --end) {
        uint top = order[first];
        order[first] = order[first + end];
        order[first + end] = top;
        sink(first, 0u, end);
    }
}
