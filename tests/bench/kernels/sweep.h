// Keys of the sort along x: the domain's width in SWEEP_KEYS equal strips, a number that the host defines. Spheres
// outside count to the nearest strip.

float stripWidth() {
    return (params.wallMax.x - params.wallMin.x) / float(SWEEP_KEYS);
}

uint keyOf(float x) {
    return uint(min(max((x - params.wallMin.x) / stripWidth(), 0.0f), float(SWEEP_KEYS - 1u)));
}
