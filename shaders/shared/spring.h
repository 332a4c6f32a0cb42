// The contact law of the model `accurate`: soft spheres.
//
// Normal force, with overlap d, effective radius R and mass m of the pair:
//   linear spring-dashpot   F = k d - c v,           k = 2 Y R,              c = 2 z sqrt(k m)
//   Hertz                   F = 2/3 S d - c v,       S = 2 Y sqrt(R d),      c = 2 z sqrt(5/6 S m)
// with Y the effective modulus and z the damping ratio of the restitution asked for, given that contacts do not pull.
// Tangential: a spring along the path of the contact point (Mindlin: 8 G sqrt(R d); linear: G/Y of the normal one), with
// a dashpot, held by Coulomb's law. Tsuji, Tanaka and Ishida 1992; Thornton, Cummins and Cleary 2013.

// Damping ratio up to which the tangential dashpot follows the normal one: it is explicit, and the contacts of a sphere
// add up.
#define MOST_DRAG 0.3f

// Over a substep, around the position it is found at: (impulse J >= 0, force F without damping, tangential stiffness k_t,
// tangential damping c_t). `speed` is the normal speed before, positive when parting.
vec4 springImpulse(float overlap, float speed, float radius, float mobility, vec4 law) {
    float h = params.substep;
    precise float mass = 1.0f / mobility;
    precise float stiffness;
    precise float force;
    precise float damping;
    precise float tangential;
    precise float part = 1.0f;
    if (HAS(HERTZ)) {
        float disc = sqrt(radius * overlap);
        stiffness = 2.0f * law.x * disc;
        force = 0.66666667f * stiffness * overlap;
        damping = 2.0f * law.y * sqrt(0.83333333f * stiffness * mass);
        tangential = 8.0f * law.z * disc;
    } else {
        stiffness = 2.0f * law.x * radius;
        force = stiffness * overlap;
        damping = 2.0f * law.y * sqrt(stiffness * mass);
        tangential = 2.0f * law.z * radius;
        // The dashpot sets in with a jump: in the first substep, only for the time since the contact began.
        precise float covered = abs(speed) * h;
        if (speed < 0.0f && overlap < covered) part = 0.5f + overlap / covered;
    }
    // The dashpot sees the mean of the speeds before and after: second order, and never more than what stops the pair.
    precise float c = min(damping * part, 2.0f / (h * mobility));
    precise float impulse = max(h * (force - c * speed) / (1.0f + 0.5f * h * c * mobility), 0.0f);
    precise float drag = 2.0f * min(law.y, MOST_DRAG) * sqrt(tangential * mass);
    if (HAS(HERTZ)) drag = drag * 0.91287093f;
    return vec4(impulse, force, tangential, drag);
}

// The tangential impulse over a substep, within `most`; `stretch` (m) is how far the surfaces have slipped since they
// met, turned into the plane of the contact, and is brought up to date.
vec3 tangentialImpulse(vec3 slip, float stiffness, float drag, float most) {
    float h = params.substep;
    precise vec3 longer = stretch + slip * h;
    stretch = longer;
    precise vec3 impulse = (stretch * stiffness + slip * drag) * -h;
    float squared = dot3(impulse, impulse);
    if (squared <= most * most) return impulse;
    impulse = impulse * (most / sqrt(squared));
    stretch = impulse * (-1.0f / (stiffness * h));
    return impulse;
}

// Into the plane across n, as long as before.
vec3 turnedInto(vec3 path, vec3 n) {
    precise vec3 within = path - n * dot3(path, n);
    float was = dot3(path, path);
    float is = dot3(within, within);
    return is > 0.0f ? within * sqrt(was / is) : within;
}
