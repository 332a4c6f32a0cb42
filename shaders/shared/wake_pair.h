// Waking in the pair passes. The includer binds `velocity` and `velocityBefore`.

// A sleeper wakes when a fast neighbour comes, or when one has moved away so far that it may no longer carry the
// sleeper. wake.comp finds neighbours that leave the wake gap in a single substep.
void wake(uint a, uint b, vec4 va, vec4 vb) {
    if (isAsleep(va) && isAwake(vb) && canWake(velocityBefore[b])) velocity[a] = sleepToggled(va);
    if (isAsleep(vb) && isAwake(va) && canWake(velocityBefore[a])) velocity[b] = sleepToggled(vb);
}
