// Friction between a sphere and a wall. The includer has the PRIVATE variables `solvedVelocity` (m/s) and `omega`
// (rad/s), and has included shared/moving.h.

vec3 relativeVelocity() {
    if (!HAS(MOTION)) return solvedVelocity;
    return solvedVelocity - surfaceVelocity;
}

// `normalImpulse` is the impulse that presses the sphere to the wall, per mass (m/s). `contact` is
// ContactParams.contact.
void applyWallFriction(vec3 n, float radius, float normalImpulse, vec4 contact) {
    vec3 relative = relativeVelocity();
    vec3 slip = relative - n * dot3(relative, n) - cross3(omega, n) * radius;
    vec3 spin = omega;
    if (HAS(MOTION)) spin = spin - surfaceSpin;
    float inverseRadius = 1.0f / radius;
    float inverseInertia = inverseRadius * inverseRadius;
    FrictionImpulse friction =
        frictionImpulse(slip, cross3(spin, n), 1.0f, inverseRadius, inverseInertia,
                        frictionOf(contact) * normalImpulse, rollingResistanceOf(contact) * radius * normalImpulse);
    vec3 moment = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(ROLLING)) {
        moment = cross3(n, friction.moment) +
                 spinningMoment(n, dot3(spin, n), 2.5f * inverseInertia,
                                spinningResistanceOf(contact) * radius * normalImpulse);
    }
    solvedVelocity = solvedVelocity + friction.impulse;
    omega = omega + (moment * inverseInertia - cross3(n, friction.impulse) * inverseRadius) * 2.5f;
}
