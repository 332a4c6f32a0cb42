// Waking in the pair passes. The includer binds `velocity` and `velocityBefore`.

// A sleeper wakes when a neighbour comes, or has crept away far enough that it may carry the sleeper no longer. One that
// leaves the wake gap in a single substep is what wake.comp looks for.
void wake(uint a, uint b, vec4 va, vec4 vb) {
    if (va.w < 0.0f && vb.w > 0.0f && canWake(velocityBefore[b])) velocity[a] = vec4(vec3(va), -va.w);
    if (vb.w < 0.0f && va.w > 0.0f && canWake(velocityBefore[a])) velocity[b] = vec4(vec3(vb), -vb.w);
}
