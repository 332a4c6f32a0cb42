// Remembers where the spheres are as the lists are built, and where each id went. Collects those outside the bounds in
// `order`, which has served by now.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/label.h"
#include "shared/outside.h"

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, readonly, uint, label, LabelBlock)
BUFFER(2, writeonly, vec4, anchor, AnchorBlock)
BUFFER(3, writeonly, uint, slotOf, SlotBlock)
BUFFER(4, coherent, uint, counters, CounterBlock)
BUFFER(5, writeonly, uint, order, OrderBlock)

KERNEL(params.spheres) {
    vec4 sphere = position[invocation];
    float room = 0.0f;
    if (finite3(vec3(sphere)) && beyond(vec3(sphere)) > 0.0f) {
        room = lost(sphere) ? UNLIMITED_ROOM : -params.margin;
        if (!lost(sphere)) order[atomicAdd(counters[COUNTER_OUTSIDE], 1u)] = invocation;
    }
    anchor[invocation] = vec4(vec3(sphere), room);
    slotOf[idOf(label[invocation])] = invocation;
}
