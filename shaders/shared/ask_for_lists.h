// The includer binds `counters` and has included shared/drift.h.

// Sets bits of COUNTER_REBUILD. Reads them first, because all spheres may ask in one substep. `all`: lists of movers alone
// are not enough.
void askForLists(bool now, bool all) {
    uint bits = now ? REBUILD_DUE | REBUILD_SOON : REBUILD_SOON;
    if (now && all) bits = bits | REBUILD_ALL;
    if ((SEEN(counters[COUNTER_REBUILD]) & bits) != bits) atomicOr(counters[COUNTER_REBUILD], bits);
}

// The most by which a sphere that moves by `motion` (m) in a substep may move relative to the drift in the next one: an
// impact may turn it back.
ANY_REAL mostNext(ANY_REAL motion) {
    vec3 drift = driftVelocity();
    return motion + sqrt(dot3(drift, drift)) * params.substep;
}
