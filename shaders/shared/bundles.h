// The order of pairs. A block is a cube of 4 x 4 x 4 cells. It owns the pairs that its cells have with themselves and
// with their forward neighbours (shared/group.h). Its pairs reach one cell beyond it, so two blocks of one colour never
// touch the same sphere: a colour is the parity of a block's place along each axis. Colours come one after the other,
// level after level.
//
// Within a block, pairs are in batches: two pairs of a batch share no sphere. A hash of the ids chooses the batch, so
// that a pair nearly always keeps its place in the order when the lists are rebuilt. (An order that changes from list
// to list costs 3 to 4 % more overlap.) Batches hold few pairs each. A bundle therefore joins BLOCKS_PER_BUNDLE blocks
// of one colour, batch by batch, which changes no result.
//
// The includer binds `bundles` if it reads a bundle's pairs.

uint levelOfPhase() {
    return (phase >> 3u) & 0xfu;
}

uint bundlesOfColour(uint level) {
    return params.levelBundles[level].y;
}

uint bundlesOfPhase() {
    return bundlesOfColour(levelOfPhase());
}

uint bundleOfPhase(uint index) {
    uint level = levelOfPhase();
    return params.levelBundles[level].x + (phase & 7u) * bundlesOfColour(level) + index;
}

uint levelOfBundle(uint bundle) {
    uint level = 0u;
    if (HAS(LEVELS))
        while (level + 1u < params.levels && bundle >= params.levelBundles[level + 1u].x) level = level + 1u;
    return level;
}

// The number of a block, by its place, among the blocks of all levels.
uint blockNumber(uvec4 cells, uint x, uint y, uint z) {
    return firstCell(cells) / 64u + (y * (cells.z / 4u) + z) * (cells.x / 4u) + x;
}

struct BlockPlace {
    uint x;  // in blocks
    uint y;
    uint z;
    bool exists;  // the last bundle of a colour may have fewer blocks
};

// The place of block `part` of the bundle.
BlockPlace blockOfBundle(uint bundle, uint level, uint part) {
    uvec4 cells = cellsOf(level);
    uint number = bundle - params.levelBundles[level].x;
    uint colour = number / bundlesOfColour(level);
    uint index = (number - colour * bundlesOfColour(level)) * BLOCKS_PER_BUNDLE + part;
    uint nx = cells.x / 8u;
    uint nz = cells.z / 8u;
    BlockPlace place;
    place.exists = index < cells.x * cells.y * cells.z / 512u;
    place.x = 2u * (index % nx) + (colour & 1u);
    place.z = 2u * ((index / nx) % nz) + (colour >> 2u);
    place.y = 2u * (index / (nx * nz)) + ((colour >> 1u) & 1u);
    return place;
}

// The number of a group of 2 x 2 x 2 cells, by its place, among the groups of all levels.
uint groupNumber(uvec4 cells, uint x, uint y, uint z) {
    return firstCell(cells) / 8u + (y * (cells.z / 2u) + z) * (cells.x / 2u) + x;
}

// The number of group `k` (0 .. 7) of a block, among the groups of all levels.
uint groupOfBlock(uvec4 cells, BlockPlace block, uint k) {
    return groupNumber(cells, 2u * block.x + (k & 1u), 2u * block.y + (k >> 2u), 2u * block.z + ((k >> 1u) & 1u));
}
