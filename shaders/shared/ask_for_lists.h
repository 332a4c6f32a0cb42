// Asks for new lists. The includer binds `counters` and `listReference`, and has included shared/wrap.h and
// shared/drift.h.

// Sets bits of COUNTER_REBUILD. Reads them first, because all spheres may ask in one substep.
void askForLists(bool now) {
    uint bits = now ? REBUILD_DUE | REBUILD_SOON : REBUILD_SOON;
    if ((SEEN(counters[COUNTER_REBUILD]) & bits) != bits) atomicOr(counters[COUNTER_REBUILD], bits);
}

// Asks for new lists in `balanced`, which must hold to the end of the next substep. `where`: spheres inside the bounds,
// which have moved to `to` with the mean velocity `v`.
void askIfSpheresLeave(mask where, uintRow at, real3 to, real3 v) {
    real3 since = to - real3(ROW(listReference, at)) - real3(driftPath());
    real3 relative = v - real3(driftVelocity());
    real moved = sqrt(dot3(since, since));
    real next = sqrt(dot3(relative, relative)) * params.substep;  // in the next substep
    mask soon = where && moved + next * SOON_SUBSTEPS > params.rebuildMove;
    if (HAS(PERIODIC)) soon = soon || (where && mustWrap(to + v * (params.substep * SOON_SUBSTEPS)));
    if (!anyLane(soon)) return;
    mask leaves = where && moved + next > params.rebuildMove;
    if (HAS(PERIODIC)) leaves = leaves || (where && mustWrap(to));
    askForLists(anyLane(leaves));
}
