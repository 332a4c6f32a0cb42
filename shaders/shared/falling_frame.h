// The frame in which those outside hold their places, kept in the counters since the last lists. The includer binds
// `counters`.

vec3 frameVector(uint first) {
    return vec3(uintBitsToFloat(counters[first]), uintBitsToFloat(counters[first + 1u]),
                uintBitsToFloat(counters[first + 2u]));
}

void setFrameVector(uint first, vec3 to) {
    counters[first] = floatBitsToUint(to.x);
    counters[first + 1u] = floatBitsToUint(to.y);
    counters[first + 2u] = floatBitsToUint(to.z);
}

// Mean velocity in this substep.
vec3 frameVelocity() {
    vec3 v = frameVector(COUNTER_FRAME_VELOCITY);
    if (HAS(GRAVITY) && counters[COUNTER_FRAME_FALLS] != 0u) v = v + vec3(params.gravity) * (0.5f * params.substep);
    return v;
}

// Where it is at the end of this substep, from where it was as the lists were built.
vec3 framePath() {
    return frameVector(COUNTER_FRAME_PATH) + frameVelocity() * params.substep;
}
