// Records the positions of the spheres when their lists are built, the slot of each id, the box of velocities, and the
// columns of the positions. If all spheres are sorted, collects the spheres outside the bounds in `cellOrder`, which is no longer needed for
// sorting.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/limits.h"
#include "shared/outside.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(writeonly, vec4, listReference)
BUFFER(writeonly, uint, slotOf)
BUFFER(writeonly, uint, busyBatches)
BUFFER(restrict, uint, carriedCount)
BUFFER(writeonly, float, sortedX)
BUFFER(writeonly, float, sortedY)
BUFFER(writeonly, float, sortedZ)
BUFFER(writeonly, float, sortedRadius)
BUFFER(coherent, uint, counters)
BUFFER(coherent, uint, cellOrder)
BUFFER(writeonly, uint, isMover)

#include "shared/movers.h"
#include "shared/mover_reach.h"
#include "shared/ordered_key.h"
#include "shared/carried.h"

void raise(uint word, uint key) {
    if (SEEN(counters[word]) < key) atomicMax(counters[word], key);
}

// The keys of x, y, z, then of -x, -y, -z.
void addToDriftBox(vec3 v) {
    raise(COUNTER_DRIFT_BOX, keyOf(v.x));
    raise(COUNTER_DRIFT_BOX + 1u, keyOf(v.y));
    raise(COUNTER_DRIFT_BOX + 2u, keyOf(v.z));
    raise(COUNTER_DRIFT_BOX + 3u, keyOf(-v.x));
    raise(COUNTER_DRIFT_BOX + 4u, keyOf(-v.y));
    raise(COUNTER_DRIFT_BOX + 5u, keyOf(-v.z));
}

KERNEL(params.spheres) {
    if (invocation >= builtSpheres()) return;
    bool alone = moversAlone();
    uint entry = alone ? counters[COUNTER_SORTED] + invocation : invocation;
    uint slot = alone ? cellOrder[entry] : entry;
    vec4 sphere = position[slot];
    if (storedRadius(sphere) < 0.0f) return;  // it is removed: see cell_of.h
    vec4 v = velocity[slot];
    float room = 0.0f;
    if (finite3(vec3(sphere)) && beyond(vec3(sphere)) > 0.0f) {
        // The room of movers among each other is not computed.
        room = lost(sphere) ? UNLIMITED_ROOM : -params.margin;
        if (!lost(sphere) && !alone) cellOrder[atomicAdd(counters[COUNTER_OUTSIDE], 1u)] = slot;
    }
    float more = alone && room == 0.0f ? moreMotion(radiusOf(sphere), v) : 0.0f;
    listReference[slot] = vec4(vec3(sphere), more > LEAST_MORE_MOTION / MORE_MOTION_UNITS ? more * MORE_MOTION_UNITS : room);
    if (HAS(MOVERS) && !alone) isMover[slot] = 0u;
    uint id = idOf(idAndMaterial[slot]);
    slotOf[id] = slot;
    if (HAS(CONTACT_MEMORY)) carriedCount[id] = withoutNextCount(carriedCount[id]);
    for (uint colour = 0u; colour < 8u; ++colour) busyBatches[colour * params.spheres + slot] = 0u;
    sortedX[entry] = sphere.x;
    sortedY[entry] = sphere.y;
    sortedZ[entry] = sphere.z;
    if (HAS(RADII)) sortedRadius[entry] = storedRadius(sphere);
    if (alone) return;
    if ((HAS(SLEEP) || HAS(FIXED)) && !isAwake(v)) {
        atomicOr(counters[COUNTER_RESTING], RESTS);
    } else if (room == 0.0f && finite3(vec3(v)) && finite3(vec3(sphere))) {
        addToDriftBox(vec3(v));
    }
}
