// The cell grid is a torus, so that memory is bounded wherever the spheres go. (Periodic axes need no more.) Cells per
// axis are multiples of 8, so that blocks of 4 x 4 x 4 cells have 8 colours (shared/bundles.h).
//
// If radii differ much, each class of sizes has a grid of its own, a level. Its cells are as wide as its largest
// sphere. Levels are ordered from fine to coarse, and the cells of a level follow the cells of the finer ones.

// Cells of a level per axis; w: its first cell.
uvec4 cellsOf(uint level) {
    if (HAS(LEVELS)) return params.levelCells[level];
    return uvec4(params.cells.x, params.cells.y, params.cells.z, 0u);
}

// 1 over the width of the cells of a level (1/m). Along a periodic axis, cells are at least as wide.
float inverseCellOf(uint level) {
    return HAS(LEVELS) ? params.levelSize[level].x : params.inverseCell;
}

// The same per axis. A whole number of cells fits the length of a periodic axis.
vec3 inverseCellsOf(uint level) {
    if (HAS(PERIODIC)) return vec3(params.cellsPerMetre[HAS(LEVELS) ? level : 0u]);
    float inverse = inverseCellOf(level);
    return vec3(inverse, inverse, inverse);
}

// A cell with more spheres of the level than this is overfull: a sample of its pairs is visited in each round.
uint sampleThreshold(uint level) {
    return uint(params.levelSize[level].z);
}

uint levelOfGroup(uint group) {
    uint level = 0u;
    if (HAS(LEVELS))
        while (level + 1u < params.levels && 8u * group >= firstCell(params.levelCells[level + 1u])) level = level + 1u;
    return level;
}

uint wrapCell(float coordinate, uint cells) {
    // Distant coordinates are clamped, because their conversion would be undefined. The shift is a multiple of the
    // cells. It keeps the operands of the remainder from being negative, which GLSL leaves undefined too.
    float bounded = min(max(floor(coordinate), -1.0e9f), 1.0e9f);
    // Most coordinates are less than one length away: a remainder takes longer.
    if (abs(bounded) < float(cells)) return uint(bounded < 0.0f ? int(bounded) + int(cells) : int(bounded));
    uint shift = (1000000000u / cells + 1u) * cells;
    return uint(int(bounded) + int(shift)) % cells;
}

// Cells are ordered by x, then z, then y. The last axis is horizontal: a share of the cells, the groups or the sorted
// spheres is a slice of the scene from bottom to top. Threads that take equal shares of each therefore find their own
// spheres, and equally many, in a pile too.
uint cellIndex(uvec4 cells, uint x, uint y, uint z) {
    return firstCell(cells) + (y * cells.z + z) * cells.x + x;
}
