// The cell grid: a torus, so that memory is bounded wherever the spheres go. Cells per axis are multiples of 4: groups of
// 2 x 2 x 2 cells then come in 8 colours, and two groups of one colour never touch the same cell.

uint wrapCell(float coordinate, uint cells) {
    // Far away coordinates are clamped before the conversion, which would be undefined for them; the shift, a multiple of
    // the cells, keeps the remainder's operands from being negative, which GLSL leaves undefined too.
    float bounded = min(max(floor(coordinate), -1.0e9f), 1.0e9f);
    uint shift = (1000000000u / cells + 1u) * cells;
    return uint(int(bounded) + int(shift)) % cells;
}

// By x, then z, then y. With a horizontal axis last, a share of the cells, the groups or the sorted spheres is a slice of the
// scene from bottom to top: threads that take the same share of each find their own spheres, and as many, in a pile too.
uint cellIndex(uint x, uint y, uint z) {
    return (y * params.cells.z + z) * params.cells.x + x;
}

uint cellOf(vec3 point) {
    if (!finite3(point)) return 0u;
    vec3 p = point * params.inverseCell;
    return cellIndex(wrapCell(p.x, params.cells.x), wrapCell(p.y, params.cells.y), wrapCell(p.z, params.cells.z));
}

// The group of the point's cell.
uint groupAt(vec3 point) {
    if (!finite3(point)) return 0u;
    vec3 p = point * params.inverseCell;
    uint row = wrapCell(p.y, params.cells.y) / 2u * (params.cells.z / 2u) + wrapCell(p.z, params.cells.z) / 2u;
    return row * (params.cells.x / 2u) + wrapCell(p.x, params.cells.x) / 2u;
}

// Group number `index` of a colour (0 .. 7): its place, as a number over all groups.
uint groupOf(uint colour, uint index) {
    uint gx = params.cells.x / 4u;
    uint gz = params.cells.z / 4u;
    uint x = 2u * (index % gx) + (colour & 1u);
    uint y = 2u * (index / (gx * gz)) + ((colour >> 1u) & 1u);
    uint z = 2u * ((index / gx) % gz) + (colour >> 2u);
    return (y * (2u * gz) + z) * (2u * gx) + x;
}
