// Remembers where the spheres are as the lists are built, and where each id went.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/label.h"

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, readonly, uint, label, LabelBlock)
BUFFER(2, writeonly, vec4, anchor, AnchorBlock)
BUFFER(3, writeonly, uint, slotOf, SlotBlock)

KERNEL(params.spheres) {
    anchor[invocation] = position[invocation];
    slotOf[idOf(label[invocation])] = invocation;
}
