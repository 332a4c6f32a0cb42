// Records the positions of the spheres when the lists are built, and the slot of each id. Collects the spheres outside
// the bounds in `cellOrder`, which is no longer needed for sorting.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/outside.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(writeonly, vec4, listReference)
BUFFER(writeonly, uint, slotOf)
BUFFER(coherent, uint, counters)
BUFFER(writeonly, uint, cellOrder)

KERNEL(params.spheres) {
    vec4 sphere = position[invocation];
    float room = 0.0f;
    if (finite3(vec3(sphere)) && beyond(vec3(sphere)) > 0.0f) {
        room = lost(sphere) ? UNLIMITED_ROOM : -params.margin;
        if (!lost(sphere)) cellOrder[atomicAdd(counters[COUNTER_OUTSIDE], 1u)] = invocation;
    }
    listReference[invocation] = vec4(vec3(sphere), room);
    slotOf[idOf(idAndMaterial[invocation])] = invocation;
}
