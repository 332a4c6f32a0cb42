// The pairs of a bundle. The includer binds `bundles`. shared/layout.h lists the words.

// Without a list: the round of the samples of overfull cells.
uint firstPair(uint bundle) {
    return bundles[bundle * BUNDLE_WORDS];
}

uint listedPairs(uint bundle) {
    return bundles[bundle * BUNDLE_WORDS + 1u];
}

bool hasList(uint bundle) {
    return listedPairs(bundle) != UNLISTED;
}

// False if all spheres of the bundle and around it sleep.
bool isActive(uint bundle) {
    return bundles[bundle * BUNDLE_WORDS + 2u] != 0u;
}

bool mayHaveSleepers(uint bundle) {
    return (bundles[bundle * BUNDLE_WORDS + 2u] & SLEEPERS) != 0u;
}

bool hasWakers(uint bundle) {
    return (bundles[bundle * BUNDLE_WORDS + 2u] & WAKERS) != 0u;
}

uint endOfBatch(uint bundle, uint batch) {
    return bundles[bundle * BUNDLE_WORDS + 4u + batch];
}

uint endOfPairs(uint bundle) {
    return bundles[bundle * BUNDLE_WORDS + 4u + BATCHES];
}

// The largest speed in this substep of the spheres in a bundle's lists, relative to the drift (m/s).
float fastestSpeed(uint bundle) {
    uint words = params.bundles * BUNDLE_WORDS;
    uint square = bundles[words + WORD_FASTEST];
    if (HAS(MOVERS) && bundle >= params.levelBundles[params.moverLevel].x)
        square = max(square, bundles[words + WORD_FASTEST_MOVER]);
    return sqrt(uintBitsToFloat(square));
}

// The first element of the contact memory of the present lists.
uint firstRemembered() {
    return bundles[params.bundles * BUNDLE_WORDS + WORD_HALF];
}
