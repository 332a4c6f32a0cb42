// What wakes a sleeping neighbour: a sphere that has moved away from where it was, or is faster than what the solver
// itself makes of a support under load.

// Takes what `velocityBefore` holds of it: the velocity before the substep, because the present one holds the kicks of
// unfinished pushes, and CREPT in place of the quiet time.
bool canWake(vec4 v) {
    return v.w == MOVED_AWAY || dot3(vec3(v), vec3(v)) > params.wakeSpeed * params.wakeSpeed;
}

// Up to this gap a sphere wakes its neighbour. It must be more than what may be crept before it is noticed, which is from
// one side of a resting place to the other: twice params.creep, at most two thirds of the margin.
float wakeGap() {
    return 0.7f * params.margin;
}
