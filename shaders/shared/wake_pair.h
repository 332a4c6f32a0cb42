// Waking in the pair passes. The includer binds `velocity` and `velocityBefore`.

// A sleeper wakes when a fast neighbour comes, or when one has moved away so far that it may no longer carry the
// sleeper. wake.comp finds neighbours that leave the wake gap in a single substep.
void wake(uint a, uint b, vec4 va, vec4 vb) {
    if (va.w < 0.0f && vb.w > 0.0f && canWake(velocityBefore[b])) velocity[a] = vec4(vec3(va), -va.w);
    if (vb.w < 0.0f && va.w > 0.0f && canWake(velocityBefore[a])) velocity[b] = vec4(vec3(vb), -vb.w);
}
