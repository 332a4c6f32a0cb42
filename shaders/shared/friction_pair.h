// Friction between two touching spheres. The includer binds `velocity` and `angularVelocity`.

// Applies friction between a and b. The normal n points from b to a. `normalImpulse` is the impulse that presses them
// together (N s). `contact` is their ContactParams.contact.
void applyPairFriction(uint a, uint b, vec3 n, float ra, float rb, float normalImpulse, vec4 contact) {
    vec4 va = velocity[a];
    vec4 vb = velocity[b];
    vec4 sa = angularVelocity[a];
    vec4 sb = angularVelocity[b];
    float ma = effectiveInverseMass(va);
    float mb = effectiveInverseMass(vb);
    vec3 difference = vec3(va) - vec3(vb);
    vec3 slip = difference - n * dot3(difference, n) - cross3(vec3(sa) * ra + vec3(sb) * rb, n);
    vec3 omega = vec3(sa) - vec3(sb);
    float inverseInertia = ma / (ra * ra) + mb / (rb * rb);
    float reducedRadius = ra * rb / (ra + rb);
    FrictionImpulse friction =
        frictionImpulse(slip, cross3(omega, n), ma + mb, ma / ra - mb / rb, inverseInertia,
                        frictionOf(contact) * normalImpulse,
                        rollingResistanceOf(contact) * reducedRadius * normalImpulse);
    vec3 slipMoment = cross3(n, friction.impulse) * 2.5f;
    vec3 moment = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(ROLLING)) {
        moment = cross3(n, friction.moment) +
                 spinningMoment(n, dot3(omega, n), 2.5f * inverseInertia,
                                spinningResistanceOf(contact) * reducedRadius * normalImpulse);
        moment = moment * 2.5f;
    }
    if (ma > 0.0f) {
        velocity[a] = withXyz(va, vec3(va) + friction.impulse * ma);
        angularVelocity[a] = withXyz(sa, vec3(sa) + moment * (ma / (ra * ra)) - slipMoment * (ma / ra));
    }
    if (mb > 0.0f) {
        velocity[b] = withXyz(vb, vec3(vb) - friction.impulse * mb);
        angularVelocity[b] = withXyz(sb, vec3(sb) - moment * (mb / (rb * rb)) - slipMoment * (mb / rb));
    }
}
