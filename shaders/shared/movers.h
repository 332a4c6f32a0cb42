// Lists of movers. In a bed at rest, one sphere that flies would ask for new lists of all spheres in nearly each substep.
// Therefore, while few spheres are awake, spheres that leave their place get lists of their own: the movers. Their grid
// of cells is one more level, coarser than the others, so that its blocks own the pairs of movers with each other and
// with all other spheres. The lists of all other spheres stay as they were built. They hold while these spheres stay
// near their list references, and a sphere that does not becomes a mover. The lists of a fast mover reach farther, so
// that they last for several substeps (shared/mover_reach.h). rebuild_decide.comp chooses which lists are built.
//
// An entry of a cell is a sphere of this cell. The lists of all spheres sort them into their cells: up to
// counters[COUNTER_SORTED], the number of an entry is the slot of its sphere. The entries of movers follow. Their slots
// are in `cellOrder`. A mover keeps its slot and its old entry, which is skipped. Its old pairs get params.farSlot in
// the place of their second sphere, so that they never touch.
//
// The includer binds `counters`. shared/entries.h has the slots of entries.

// Lists of movers are built at most this many times in succession (shared/carried.h).
#define MOST_MOVER_LISTS 120u
// Movers that sleep join the others again once they are more than this number, and more than those that are awake.
#define FEW_SLEEPING_MOVERS 1024u
// The room that lists of movers must have for each, in pairs.
#define PAIRS_OF_MOVER 12u

// COUNTER_MOVERS_ALONE before and after list_drift.comp: until then, the lists are the old ones.
#define LISTS_BEGUN 2u
#define LISTS_BUILT 1u

bool moversAlone() {
    return HAS(MOVERS) && counters[COUNTER_MOVERS_ALONE] != 0u;
}

// The spheres whose lists are built, the first of their cells, and the first of their bundles.
uint builtSpheres() {
    return moversAlone() ? min(counters[COUNTER_MOVERS], counters[COUNTER_MOVER_ROOM]) : params.spheres;
}

uint firstBuiltCell() {
    return moversAlone() ? params.firstMoverCell : 0u;
}

uint firstBuiltBundle() {
    return moversAlone() ? params.levelBundles[params.moverLevel].x : 0u;
}
