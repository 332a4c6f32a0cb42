// The blocks that spheres have left to become movers (movers_collect.comp). The includer has included shared/bundles.h,
// and binds `leftBlock` and `counters`.

// Returns true if a sphere has left one of the bundle's blocks to become a mover, or was within a cell of it.
bool wasLeft(uint bundle) {
    uvec4 cells = cellsOf(0u);
    for (uint part = 0u; part < BLOCKS_PER_BUNDLE; ++part) {
        BlockPlace block = blockOfBundle(bundle, 0u, part);
        if (block.exists && leftBlock[blockNumber(cells, block.x, block.y, block.z)] == counters[COUNTER_REBUILDS])
            return true;
    }
    return false;
}
