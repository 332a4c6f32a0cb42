// Friction between two touching spheres. The includer binds `velocity` and `angularVelocity`.

// Applies friction between a and b. The normal n points from b to a. `pressing` is the impulse that presses them
// together (N s). `law` is their ContactParams.contact.
void applyPairFriction(uint a, uint b, vec3 n, float ra, float rb, float pressing, vec4 law) {
    vec4 va = velocity[a];
    vec4 vb = velocity[b];
    vec4 sa = angularVelocity[a];
    vec4 sb = angularVelocity[b];
    float ma = mobility(va.w);
    float mb = mobility(vb.w);
    vec3 difference = vec3(va) - vec3(vb);
    vec3 slip = difference - n * dot3(difference, n) - cross3(vec3(sa) * ra + vec3(sb) * rb, n);
    vec3 omega = vec3(sa) - vec3(sb);
    float inertia = ma / (ra * ra) + mb / (rb * rb);
    float lever = ra * rb / (ra + rb);
    FrictionImpulse got = frictionImpulse(slip, cross3(omega, n), ma + mb, ma / ra - mb / rb, inertia, law.y * pressing,
                  law.z * lever * pressing);
    vec3 twist = cross3(n, got.impulse) * 2.5f;
    vec3 moment = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(ROLLING)) {
        moment = cross3(n, got.moment) +
                 spinningMoment(n, dot3(omega, n), 2.5f * inertia, law.w * lever * pressing);
        moment = moment * 2.5f;
    }
    if (ma > 0.0f) {
        velocity[a] = vec4(vec3(va) + got.impulse * ma, va.w);
        angularVelocity[a] = vec4(vec3(sa) + moment * (ma / (ra * ra)) - twist * (ma / ra), sa.w);
    }
    if (mb > 0.0f) {
        velocity[b] = vec4(vec3(vb) - got.impulse * mb, vb.w);
        angularVelocity[b] = vec4(vec3(sb) - moment * (mb / (rb * rb)) - twist * (mb / rb), sb.w);
    }
}
