// Remembers where the spheres are as the lists are built, and where each id went. Collects those outside the bounds in
// `cellOrder`, which has served by now.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/id_and_material.h"
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
