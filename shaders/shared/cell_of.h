// The cell and the block of a point.

uint levelOf(float radius) {
    uint level = 0u;
    if (HAS(LEVELS))
        while (level + 1u < params.levels && radius > largestRadius(level)) level = level + 1u;
    return level;
}

// The place of the point's cell on a level: x, y, z. It is the first cell if the point is not finite.
uvec4 cellPlaceAt(vec3 point, uint level) {
    if (!finite3(point)) return uvec4(0u, 0u, 0u, 0u);
    uvec4 cells = cellsOf(level);
    vec3 p = point * inverseCellsOf(level);
    return uvec4(wrapCell(p.x, cells.x), wrapCell(p.y, cells.y), wrapCell(p.z, cells.z), 0u);
}

uint cellAtLevel(vec3 point, uint level) {
    uvec4 place = cellPlaceAt(point, level);
    return cellIndex(cellsOf(level), place.x, place.y, place.z);
}

// The cell of a sphere on its level. A sphere that is removed has a negative radius until the lists are rebuilt. It comes
// after all cells, so that it is behind the other spheres then, and the lists leave it out.
uint cellOf(vec4 sphere) {
    if (storedRadius(sphere) < 0.0f) return allCells();
    return cellAtLevel(vec3(sphere), levelOf(storedRadius(sphere)));
}

// The number of the point's block of 4 x 4 x 4 cells among the blocks of all levels.
uint blockAt(vec3 point, uint level) {
    uvec4 place = cellPlaceAt(point, level);
    return blockNumber(cellsOf(level), place.x / 4u, place.y / 4u, place.z / 4u);
}
