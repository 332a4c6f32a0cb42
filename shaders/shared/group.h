// Pairs of a group of 2 x 2 x 2 cells: of its cells with themselves and with their 13 forward neighbours. The includer
// defines `void visitPair(uint a, uint b)` before, and binds `cellStart`.

// One call of visitPair in the text: GLSL compilers copy it to each place, which costs seconds.
void visitCell(uint x, uint y, uint z) {
    uint cell = cellIndex(x, y, z);
    uint first = cellStart[cell];
    uint last = cellStart[cell + 1u];
    if (first == last) return;
    uint nx = params.cells.x;
    uint ny = params.cells.y;
    uint west = x == 0u ? nx - 1u : x - 1u;
    uint east = x + 1u == nx ? 0u : x + 1u;
    uint north = y + 1u == ny ? 0u : y + 1u;
    uint south = y == 0u ? ny - 1u : y - 1u;
    uint above = z + 1u == params.cells.z ? 0u : z + 1u;
    bool whole = x > 0u && x + 1u < nx;
    // Row 0: the cell itself and the one to the east. The others: cells x - 1 .. x + 1 of the rows north, south above,
    // above and north above, each one range of the sorted spheres unless the torus cuts it.
    for (uint row = 0u; row < 5u; ++row) {
        uint ry = row == 0u || row == 3u ? y : (row == 2u ? south : north);
        uint start = cellIndex(0u, ry, row < 2u ? z : above);
        uint parts = row == 0u ? 2u : (whole ? 1u : 3u);
        for (uint part = 0u; part < parts; ++part) {
            uint from = row == 0u ? (part == 0u ? x : east) : (part == 0u ? west : (part == 1u ? x : east));
            uint to = row > 0u && whole ? east : from;
            uint begin = cellStart[start + from];
            uint end = cellStart[start + to + 1u];
            for (uint a = first; a < last; ++a)
                for (uint b = row + part == 0u ? a + 1u : begin; b < end; ++b) visitPair(a, b);
        }
    }
}

void visitGroup(uint x, uint y, uint z) {
    for (uint k = 0u; k < 8u; ++k) visitCell(2u * x + (k & 1u), 2u * y + ((k >> 1u) & 1u), 2u * z + (k >> 2u));
}

void visitGroupNumber(uint group) {
    uint gx = params.cells.x / 2u;
    uint gz = params.cells.z / 2u;
    visitGroup(group % gx, group / (gx * gz), (group / gx) % gz);
}
