// Marks the groups that hold an awake sphere, by the number of the substep. It marks the sphere's group on its own
// level and on the coarser ones, whose groups have its pairs with larger spheres. It does not mark finer levels,
// because the sphere's own group has these pairs. A smaller sphere that it wakes marks its own group in the next
// substep. A sphere that is in no list marks no group.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/outside.h"

BUFFER(readonly, vec4, velocity)
BUFFER(readonly, vec4, listReference)  // position for which the lists were built: it gives the sphere's cell
BUFFER(readonly, uint, counters)
BUFFER(coherent, uint, activeGroup)
BUFFER(readonly, vec4, position)

KERNEL(params.spheres) {
    if (isAsleep(velocity[invocation])) return;
    vec4 reference = listReference[invocation];
    uint levels = HAS(LEVELS) ? params.levels : 1u;
    if (roomOf(reference) > 0.0f && beyondStrip(vec3(reference))) return;
    for (uint level = levelOf(storedRadius(position[invocation])); level < levels; ++level)
        atomicExchange(activeGroup[groupAt(vec3(reference), level)], counters[COUNTER_SUBSTEPS]);
}
