// Puts each sphere into the next free slot of its cell.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "tally.h"
#include "slots.h"

BUFFER(readonly, vec4, position)
BUFFER(coherent, uint, occupied)
BUFFER(writeonly, uint, cells)
BUFFER(coherent, uint, tally)

KERNEL(params.spheres) {
    uvec3 place = cellAt(vec3(position[invocation]));
    uint cell = cellNumber(place.x, place.y, place.z);
    uint slot = atomicAdd(occupied[cell], 1u);
    if (slot < SLOTS) {
        cells[cell * SLOTS + slot] = invocation;
    } else {
        atomicAdd(tally[TALLY_OVERFLOWED], 1u);
    }
}
