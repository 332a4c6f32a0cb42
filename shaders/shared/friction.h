// Friction and rolling between two bodies that touch, for solid spheres (I = 2/5 m r^2), as impulses.
//
// With the normal n from b to a, the contact velocity (of a's surface relative to b's) is
//       slip = (va - vb) tangential - (ra wa + rb wb) x n.
// An impulse J on a (and -J on b) changes slip by 7/2 (1/ma + 1/mb) J. A rolling moment T on a (and -T on b) changes wa
// - wb by 5/2 (1/(ma ra^2) + 1/(mb rb^2)) T. A wall is a body b of infinite mass and radius.

struct FrictionImpulse {
    vec3 impulse;   // J, N s
    vec3 moment;    // T x n, N s m
};

// The moment about n that slows a spin of `about` (rad/s) about n, at most `most` (N s m). `c`: change of the spin per
// moment.
ANY_REAL3 spinningMoment(ANY_REAL3 n, ANY_REAL about, ANY_REAL c, ANY_REAL most) {
    ANY_REAL moment = min(abs(about) / c, most);
    return n * select(about < 0.0f, moment, -moment);
}

// The moment that slows rolling at `roll` (rad/s, in the plane of the contact), at most `most` (N s m).
ANY_REAL3 rollingMoment(ANY_REAL3 roll, ANY_REAL c, ANY_REAL most) {
    ANY_REAL speed = sqrt(dot3(roll, roll));
    return roll * (-min(speed / c, most) / max(speed, 1.0e-30f));
}

// Finds the impulse and the moment that stop slip and roll together, where roll = (wa - wb) x n. Their limits are
// `maxImpulse` (N s) and `maxMoment` (N s m). If either exceeds its limit, finds the ones that stop slip and roll
// separately, each cut to its limit.
// `inverseMassSum` = 1/ma + 1/mb, `coupling` = 1/(ma ra) - 1/(mb rb), `inverseInertia` = 1/(ma ra^2) + 1/(mb rb^2).
FrictionImpulse frictionImpulse(vec3 slip, vec3 roll, float inverseMassSum, float coupling, float inverseInertia,
                                float maxImpulse, float maxMoment) {
    FrictionImpulse result;
    float s = 3.5f * inverseMassSum;
    float c = 2.5f * inverseInertia;
    if (HAS(ROLLING)) {
        // slip + s J - b T = 0 and roll - b J + c T = 0.
        float b = 2.5f * coupling;
        float inverse = 1.0f / (s * c - b * b);
        result.impulse = (slip * c + roll * b) * -inverse;
        result.moment = (roll * s + slip * b) * -inverse;
        if (dot3(result.impulse, result.impulse) <= maxImpulse * maxImpulse &&
            dot3(result.moment, result.moment) <= maxMoment * maxMoment)
            return result;
        result.moment = rollingMoment(roll, c, maxMoment);
    }
    float speed = sqrt(dot3(slip, slip));
    float impulse = min(speed / s, maxImpulse);
    result.impulse = slip * (speed > 0.0f ? -impulse / speed : 0.0f);
    return result;
}
