// Friction between a sphere and a wall. The includer has the PRIVATE `corrected` (m/s) and `turning` (rad/s).

// `pressing` is what presses the sphere to the wall, per mass (m/s); `law` is Law.contact.
void rubWall(vec3 n, float radius, float pressing, vec4 law) {
    vec3 slip = corrected - n * dot3(corrected, n) - cross3(turning, n) * radius;
    float lever = 1.0f / radius;
    float inertia = lever * lever;
    Rub got = rub(slip, cross3(turning, n), 1.0f, lever, inertia, law.y * pressing, law.z * radius * pressing);
    vec3 moment = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(ROLLING)) {
        moment = cross3(n, got.moment) +
                 spinningMoment(n, dot3(turning, n), 2.5f * inertia, law.w * radius * pressing);
    }
    corrected = corrected + got.impulse;
    turning = turning + (moment * inertia - cross3(n, got.impulse) * lever) * 2.5f;
}
