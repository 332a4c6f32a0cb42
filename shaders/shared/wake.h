// A sphere wakes a sleeping neighbour if it has moved away from its place, or if it is faster than a support under
// load.

// A blow may make a sphere faster than the wake speed within a substep, too late to wake a sleeper that it meets. Now
// the sleeper would act as a wall, and take the momentum of the blow. So the contact waits for the next substep, before
// which the sleeper wakes. It does not wait if the spheres would come nearer by more than this in a substep, in smaller
// radii, because they could pass each other.
#define MOST_WAIT 0.5f

// `v` and `rest` are the sphere's rows of `velocity` and `restReference`.
bool canWake(vec4 v, vec4 rest) {
    return hasMovedAway(rest) || dot3(vec3(v), vec3(v)) > params.wakeSpeed * params.wakeSpeed;
}

// A sphere wakes its neighbour up to this gap (m). The gap must exceed the distance that a sphere can move before it
// counts as moved away. That distance is from one side of a resting place to the other: twice params.moveAwayDistance,
// at most two thirds of the margin.
float wakeGap() {
    return 0.7f * params.margin;
}
