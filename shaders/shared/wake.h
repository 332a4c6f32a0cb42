// A sphere wakes a sleeping neighbour if it has moved away from its place, or if it is faster than a support under
// load.

// True if a sphere of this velocity (m/s) wakes sleepers. One that became fast in the present substep, by a blow, has not
// woken its neighbours yet. Their contacts wait for the next substep, because a sleeper holds like a wall and would take the
// momentum of the blow.
ANY_MASK isFast(ANY_REAL3 v) {
    return dot3(v, v) > params.wakeSpeed * params.wakeSpeed;
}

// `v` and `rest` are the sphere's rows of `velocity` and `restReference`.
bool canWake(vec4 v, vec4 rest) {
    return hasMovedAway(rest) || isFast(vec3(v));
}

// A sphere wakes its neighbour up to this gap (m). The gap must exceed the distance that a sphere can move before it
// counts as moved away. That distance is from one side of a resting place to the other: twice params.moveAwayDistance,
// at most two thirds of the margin.
float wakeGap() {
    return 0.7f * params.margin;
}
