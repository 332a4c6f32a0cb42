// Pairs of a group of 2 x 2 x 2 cells: of its cells with themselves and with their 13 forward neighbours. The includer
// defines `void visitPair(uint a, uint b)` before, and binds `cellStart`.

void visitRange(uint first, uint last, uint start, uint end) {
    for (uint a = first; a < last; ++a)
        for (uint b = start; b < end; ++b) visitPair(a, b);
}

// Cells x - 1 .. x + 1 of a row: one range of the sorted spheres, unless the torus cuts it.
void visitRow(uint first, uint last, uint x, uint y, uint z) {
    uint nx = params.cells.x;
    uint row = cellIndex(0u, y, z);
    if (x > 0u && x + 1u < nx) {
        visitRange(first, last, cellStart[row + x - 1u], cellStart[row + x + 2u]);
    } else {
        uint west = x == 0u ? nx - 1u : x - 1u;
        uint east = x + 1u == nx ? 0u : x + 1u;
        visitRange(first, last, cellStart[row + west], cellStart[row + west + 1u]);
        visitRange(first, last, cellStart[row + x], cellStart[row + x + 1u]);
        visitRange(first, last, cellStart[row + east], cellStart[row + east + 1u]);
    }
}

void visitCell(uint x, uint y, uint z) {
    uint cell = cellIndex(x, y, z);
    uint first = cellStart[cell];
    uint last = cellStart[cell + 1u];
    if (first == last) return;
    uint nx = params.cells.x;
    uint ny = params.cells.y;
    uint north = y + 1u == ny ? 0u : y + 1u;
    uint south = y == 0u ? ny - 1u : y - 1u;
    uint above = z + 1u == params.cells.z ? 0u : z + 1u;
    uint east = cellIndex(x + 1u == nx ? 0u : x + 1u, y, z);
    for (uint a = first; a < last; ++a)
        for (uint b = a + 1u; b < last; ++b) visitPair(a, b);
    visitRange(first, last, cellStart[east], cellStart[east + 1u]);
    visitRow(first, last, x, north, z);
    visitRow(first, last, x, south, above);
    visitRow(first, last, x, y, above);
    visitRow(first, last, x, north, above);
}

void visitGroup(uint x, uint y, uint z) {
    for (uint k = 0u; k < 8u; ++k) visitCell(2u * x + (k & 1u), 2u * y + ((k >> 1u) & 1u), 2u * z + (k >> 2u));
}

// Group number `index` of a colour (0 .. 7): its place, as a number over all groups.
uint groupOf(uint colour, uint index) {
    uint gx = params.cells.x / 4u;
    uint gy = params.cells.y / 4u;
    uint x = 2u * (index % gx) + (colour & 1u);
    uint y = 2u * ((index / gx) % gy) + ((colour >> 1u) & 1u);
    uint z = 2u * (index / (gx * gy)) + (colour >> 2u);
    return (z * (2u * gy) + y) * (2u * gx) + x;
}

void visitGroupNumber(uint group) {
    uint gx = params.cells.x / 2u;
    uint gy = params.cells.y / 2u;
    visitGroup(group % gx, (group / gx) % gy, group / (gx * gy));
}
