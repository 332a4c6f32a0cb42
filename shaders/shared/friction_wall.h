// Friction between a sphere and a wall. The includer has the PRIVATE variables `solvedVelocity` (m/s) and `omega`
// (rad/s).

// `pressing` is the impulse that presses the sphere to the wall, per mass (m/s). `law` is ContactParams.contact.
void applyWallFriction(vec3 n, float radius, float pressing, vec4 law) {
    vec3 slip = solvedVelocity - n * dot3(solvedVelocity, n) - cross3(omega, n) * radius;
    float lever = 1.0f / radius;
    float inertia = lever * lever;
    FrictionImpulse got = frictionImpulse(slip, cross3(omega, n), 1.0f, lever, inertia, law.y * pressing, law.z * radius * pressing);
    vec3 moment = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(ROLLING)) {
        moment = cross3(n, got.moment) +
                 spinningMoment(n, dot3(omega, n), 2.5f * inertia, law.w * radius * pressing);
    }
    solvedVelocity = solvedVelocity + got.impulse;
    omega = omega + (moment * inertia - cross3(n, got.impulse) * lever) * 2.5f;
}
