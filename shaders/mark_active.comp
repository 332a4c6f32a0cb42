// Marks the groups that hold a sphere that is awake, with the number of the substep: on its level, and on the coarser ones,
// whose groups have the pairs that it makes with larger spheres. Not on finer ones: those pairs are its own group's, and who
// is woken by it marks its own group in the next substep. A sphere that is in no list stirs nothing.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/outside.h"

BUFFER(readonly, vec4, velocity)
BUFFER(readonly, vec4, listReference)  // which cell the lists have it in
BUFFER(readonly, uint, counters)
BUFFER(coherent, uint, activeGroup)
BUFFER(readonly, vec4, position)

KERNEL(params.spheres) {
    if (velocity[invocation].w < 0.0f) return;
    vec4 sphere = listReference[invocation];
    uint levels = HAS(LEVELS) ? params.levels : 1u;
    if (sphere.w > 0.0f && beyondStrip(vec3(sphere))) return;
    for (uint level = levelOf(position[invocation].w); level < levels; ++level)
        atomicExchange(activeGroup[groupAt(vec3(sphere), level)], counters[COUNTER_SUBSTEPS]);
}
