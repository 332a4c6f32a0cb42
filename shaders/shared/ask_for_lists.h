// The includer binds `counters`.

// Sets bits of COUNTER_REBUILD. Reads them first, because all spheres may ask in one substep.
void askForLists(bool now) {
    uint bits = now ? REBUILD_DUE | REBUILD_SOON : REBUILD_SOON;
    if ((SEEN(counters[COUNTER_REBUILD]) & bits) != bits) atomicOr(counters[COUNTER_REBUILD], bits);
}
