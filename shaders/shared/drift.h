// The drift: a velocity in whose frame the lists hold. A scene that moves as a whole then needs no new lists.
// list_drift.comp chooses it. The includer binds `counters`.

vec3 driftVelocity() {
    return vec3(uintBitsToFloat(counters[COUNTER_DRIFT]), uintBitsToFloat(counters[COUNTER_DRIFT + 1u]),
                uintBitsToFloat(counters[COUNTER_DRIFT + 2u]));
}

// The path of the drift (m) from the building of the lists to the end of this substep.
vec3 driftPath() {
    vec3 path = vec3(uintBitsToFloat(counters[COUNTER_DRIFT_PATH]), uintBitsToFloat(counters[COUNTER_DRIFT_PATH + 1u]),
                     uintBitsToFloat(counters[COUNTER_DRIFT_PATH + 2u]));
    return path + driftVelocity() * params.substep;
}
