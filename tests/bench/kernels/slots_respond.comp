// Tests every sphere against the spheres in its own cell and the 26 cells around it.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/contact.h"
#include "tally.h"
#include "response.h"
#include "slots.h"

BUFFER(readonly, uint, occupied)
BUFFER(readonly, uint, cells)

void meetCell(uint cell) {
    uint count = min(occupied[cell], SLOTS);
    for (uint slot = 0u; slot < count; ++slot) meet(cells[cell * SLOTS + slot]);
}

KERNEL(params.spheres) {
    begin(invocation);
    uvec3 centre = cellAt(here);
    uvec3 first = max(centre, uvec3(1u)) - uvec3(1u);
    uvec3 last = min(centre + uvec3(1u), uvec3(params.cells) - uvec3(1u));
    for (uint z = first.z; z <= last.z; ++z)
        for (uint y = first.y; y <= last.y; ++y)
            for (uint x = first.x; x <= last.x; ++x) meetCell(cellNumber(x, y, z));
    finish();
}
