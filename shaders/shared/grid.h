// The cell grid is a torus, so that memory is bounded wherever the spheres go. Cells per axis are multiples of 4.
// Groups of 2 x 2 x 2 cells therefore have 8 colours, and two groups of one colour never touch the same cell.
//
// If radii differ much, each class of sizes has a grid of its own, a level. Its cells are as wide as its largest
// sphere. Levels are ordered from fine to coarse, and the cells of a level follow the cells of the finer ones.

// Cells of a level per axis; w: its first cell.
uvec4 cellsOf(uint level) {
    if (HAS(LEVELS)) return params.levelCells[level];
    return uvec4(params.cells.x, params.cells.y, params.cells.z, 0u);
}

float inverseCellOf(uint level) {
    return HAS(LEVELS) ? params.levelSize[level].x : params.inverseCell;
}

// A cell with more spheres of the level than this is overfull: a sample of its pairs is visited in each round.
uint sampleThreshold(uint level) {
    return uint(params.levelSize[level].z);
}

uint levelOf(float radius) {
    uint level = 0u;
    if (HAS(LEVELS))
        while (level + 1u < params.levels && radius > largestRadius(level)) level = level + 1u;
    return level;
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
    uint shift = (1000000000u / cells + 1u) * cells;
    return uint(int(bounded) + int(shift)) % cells;
}

// Cells are ordered by x, then z, then y. The last axis is horizontal: a share of the cells, the groups or the sorted
// spheres is a slice of the scene from bottom to top. Threads that take equal shares of each therefore find their own
// spheres, and equally many, in a pile too.
uint cellIndex(uvec4 cells, uint x, uint y, uint z) {
    return firstCell(cells) + (y * cells.z + z) * cells.x + x;
}

// The cell of a sphere on its level.
uint cellOf(vec4 sphere) {
    vec3 point = vec3(sphere);
    if (!finite3(point)) return 0u;
    uint level = levelOf(storedRadius(sphere));
    uvec4 cells = cellsOf(level);
    vec3 p = point * inverseCellOf(level);
    return cellIndex(cells, wrapCell(p.x, cells.x), wrapCell(p.y, cells.y), wrapCell(p.z, cells.z));
}

// The group of the point's cell.
uint groupAt(vec3 point, uint level) {
    if (!finite3(point)) return 0u;
    uvec4 cells = cellsOf(level);
    vec3 p = point * inverseCellOf(level);
    uint row = wrapCell(p.y, cells.y) / 2u * (cells.z / 2u) + wrapCell(p.z, cells.z) / 2u;
    return firstCell(cells) / 8u + row * (cells.x / 2u) + wrapCell(p.x, cells.x) / 2u;
}

// The level of a launch over groups: its phase holds level and colour (0 .. 7).
uint levelOfPhase() {
    return HAS(LEVELS) ? phase >> 3u : 0u;
}

// The number of groups of the launch's level that have its colour.
uint groupsOfPhase() {
    if (!HAS(LEVELS)) return params.groups;
    uvec4 cells = cellsOf(levelOfPhase());
    return cells.x * cells.y * cells.z / 64u;
}

// The group with number `index` among these, as a number over all groups.
uint groupOfPhase(uint index) {
    uvec4 cells = cellsOf(levelOfPhase());
    uint gx = cells.x / 4u;
    uint gz = cells.z / 4u;
    uint x = 2u * (index % gx) + (phase & 1u);
    uint y = 2u * (index / (gx * gz)) + ((phase >> 1u) & 1u);
    uint z = 2u * ((index / gx) % gz) + ((phase >> 2u) & 1u);
    return firstCell(cells) / 8u + (y * (2u * gz) + z) * (2u * gx) + x;
}
