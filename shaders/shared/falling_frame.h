// The frame of reference that falls with the spheres outside the bounds, by gravity alone: it need not follow them
// exactly. The counters hold its motion since the lists were built. The includer binds `counters`.

vec3 frameVector(uint first) {
    return vec3(uintBitsToFloat(counters[first]), uintBitsToFloat(counters[first + 1u]),
                uintBitsToFloat(counters[first + 2u]));
}

void setFrameVector(uint first, vec3 to) {
    counters[first] = floatBitsToUint(to.x);
    counters[first + 1u] = floatBitsToUint(to.y);
    counters[first + 2u] = floatBitsToUint(to.z);
}

// The mean velocity of the frame in this substep (m/s).
vec3 frameVelocity() {
    vec3 v = frameVector(COUNTER_FRAME_VELOCITY);
    if (HAS(GRAVITY) && counters[COUNTER_FRAME_FALLS] != 0u) v = v + vec3(params.gravity) * (0.5f * params.substep);
    return v;
}

// The path of the frame (m) from its place when the lists were built to its place at the end of this substep.
vec3 framePath() {
    return frameVector(COUNTER_FRAME_PATH) + frameVelocity() * params.substep;
}
