// Keys of the sort along x: the width of the domain is divided into SWEEP_KEYS equal strips. The host defines
// SWEEP_KEYS. A sphere outside the domain belongs to the nearest strip.

float stripWidth() {
    return (params.wallMax.x - params.wallMin.x) / float(SWEEP_KEYS);
}

uint keyOf(float x) {
    return uint(min(max((x - params.wallMin.x) / stripWidth(), 0.0f), float(SWEEP_KEYS - 1u)));
}
