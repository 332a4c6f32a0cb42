// Puts each sphere into the next free slot of its cell.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "tally.h"
#include "slots.h"

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, coherent, uint, occupied, OccupiedBlock)
BUFFER(2, writeonly, uint, cells, CellBlock)
BUFFER(3, coherent, uint, tally, TallyBlock)

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
