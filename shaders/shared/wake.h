// What wakes a sleeping neighbour: a sphere that is faster than the wake speed, or has crept.

// Takes what `before` holds of it: the velocity before the substep, because the present one holds the kicks of
// unfinished pushes, and CREPT in place of the quiet time.
bool wakes(vec4 v) {
    return v.w == CREPT || dot3(vec3(v), vec3(v)) > params.wakeSpeed * params.wakeSpeed;
}
