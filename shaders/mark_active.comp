// Marks the blocks and groups of cells that hold an awake sphere, and the groups that hold one that may wake others, by the
// number of the substep. It marks them on the sphere's own level, and on coarser levels, whose blocks have its pairs with
// larger spheres. It does not mark finer levels, because the sphere's own block has these pairs. A smaller sphere that it
// wakes marks its own block in the next substep. A sphere that is in no list marks nothing. Counts the spheres that soon
// become movers (shared/movers.h), and the awake movers. Also marks the blocks that hold a restless sphere (sleep.comp):
// an awake one that has not been quiet for the sleep time and carries others.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/bundles.h"
#include "shared/cell_of.h"
#include "shared/limits.h"
#include "shared/outside.h"

BUFFER(readonly, vec4, velocity)
BUFFER(readonly, vec4, listReference)  // position for which the lists were built: it gives the sphere's cell
BUFFER(coherent, uint, counters)
BUFFER(coherent, uint, activeBlock)
BUFFER(coherent, uint, activeGroup)
BUFFER(coherent, uint, wakerGroup)
BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, restReference)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(coherent, uint, restlessBlock)
BUFFER(readonly, vec4, unheldVelocity)
BUFFER(readonly, uint, isMover)

#include "shared/leaving.h"
#include "shared/wake.h"

// A sphere with fewer contacts lies on others. It may roll about for long without changing what they carry.
#define RESTLESS_PAIRS 5.0f

KERNEL(params.spheres) {
    vec4 v = velocity[invocation];
    if (!isAwake(v)) return;
    vec4 reference = listReference[invocation];
    bool mover = HAS(MOVERS) && isMover[invocation] != 0u;
    if (mover) atomicAdd(counters[COUNTER_AWAKE_MOVERS], 1u);
    if (HAS(MOVERS) && !mover && SEEN(counters[COUNTER_LEAVING]) <= params.mostMovers &&
        mostMoved(vec3(position[invocation]) - vec3(reference), vec3(v)) > LEAVES_SOON * params.rebuildMove)
        atomicAdd(counters[COUNTER_LEAVING], 1u);
    uint levels = HAS(LEVELS) ? params.levels : 1u;
    if (HAS(MOVERS) && counters[COUNTER_MOVERS] == 0u) levels = params.moverLevel;
    if (roomOf(reference) > 0.0f && beyondStrip(vec3(reference))) return;
    uint substep = counters[COUNTER_SUBSTEPS];
    uint own = levelOf(storedRadius(position[invocation]));
    vec4 rest = restReference[idOf(idAndMaterial[invocation])];
    bool wakes = canWake(v, rest);
    // Only with friction do spheres fall asleep together.
    bool restless = HAS(BALANCED) && HAS(FRICTION) && quietTimeOf(rest) < params.sleepTime &&
                    heldPairs(unheldVelocity[invocation].w) >= RESTLESS_PAIRS;
    for (uint level = own; level < levels; ++level) {
        bool listed = !mover || level != own;  // the lists of its own level have no pairs of a mover
        if (!listed && !restless) continue;
        uvec4 cells = cellsOf(level);
        uvec4 place = cellPlaceAt(vec3(reference), level);
        uint block = blockNumber(cells, place.x / 4u, place.y / 4u, place.z / 4u);
        if (restless && level == own) atomicExchange(restlessBlock[block], substep);
        if (!listed) continue;
        uint group = groupNumber(cells, place.x / 2u, place.y / 2u, place.z / 2u);
        if (SEEN(activeBlock[block]) != substep) atomicExchange(activeBlock[block], substep);
        if (SEEN(activeGroup[group]) != substep) atomicExchange(activeGroup[group], substep);
        if (wakes && SEEN(wakerGroup[group]) != substep) atomicExchange(wakerGroup[group], substep);
    }
}
