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

uint endOfBatch(uint bundle, uint batch) {
    return bundles[bundle * BUNDLE_WORDS + 4u + batch];
}

uint endOfPairs(uint bundle) {
    return bundles[bundle * BUNDLE_WORDS + 4u + BATCHES];
}

// The largest speed of a sphere in this substep, relative to the drift (m/s).
float fastestSpeed() {
    return sqrt(uintBitsToFloat(bundles[params.bundles * BUNDLE_WORDS + WORD_FASTEST]));
}

// The first element of the contact memory of the present lists.
uint firstRemembered() {
    return bundles[params.bundles * BUNDLE_WORDS + WORD_HALF];
}
