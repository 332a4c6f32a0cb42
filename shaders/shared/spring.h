// The contact law of the model `accurate`: soft spheres. The includer has the PRIVATE `displacement`.
//
// Normal force, with overlap d, effective radius R and mass m of the pair:
//   linear spring-dashpot   F = k d - c v,           k = 2 Y R,              c = 2 z sqrt(k m)
//   Hertz                   F = 2/3 S d - c v,       S = 2 Y sqrt(R d),      c = 2 z sqrt(5/6 S m)
// with Y the effective modulus and z the damping ratio of the restitution asked for, given that contacts do not pull.
// Tangential: a spring and a dashpot side by side,
//   linear spring-dashpot   F = k_t x + c_t u,       k_t = 2 G R
//   Mindlin                 the same,                k_t = 8 G sqrt(R d)
// with u the slip, x the stretch of the spring and G the effective shear modulus. While the contact sticks, x grows with
// the slip. As a Hertz contact closes, F keeps what it has and x shrinks with 1 / k_t; as it opens, x stays and F falls
// with k_t: so a contact never gains energy (Thornton, Cummins and Cleary 2013; `mindlin_rescale` in LAMMPS). Where F would
// exceed Coulomb's limit it is held there, and the spring takes what the dashpot leaves: x = (limit - c_t u) / k_t (Luding
// 2008, Granular Matter 10, 235).
//
// Positions are known at the end of a substep, velocities before and after the impulse that acts there: an impulse stands
// for half a substep before and half a substep after.

// Damping ratio up to which the tangential dashpot follows the normal one: the dashpots of all contacts of a sphere add
// up.
#define MOST_DRAG 0.3f

// A contact in a substep.
struct Spring {
    float impulse;  // normal, N s, >= 0
    float now;      // N: the normal force at the end of the substep's motion
    float stiff;    // N/m: k_t
    float drag;     // N s/m: c_t
    float share;    // of the motion, from when on they touched: 1 unless the contact has just begun
    float part;     // of a substep that the dashpots' impulse stands for: 1 unless it has just begun
    float acted;    // share of the impulse that acts before the end of the motion
    float closed;   // k_t before the motion over k_t now; 1 where the contact opens
    float onset;    // N: the normal force with which the contact has begun, by its dashpot
};

// `path` is the normal speed in the substep's motion, `speed` that before the impulse; both are positive when parting.
Spring springOf(float overlap, float path, float speed, float radius, float mobility, vec4 law) {
    Spring spring;
    float h = params.substep;
    precise float mass = 1.0f / mobility;
    precise float before = overlap + path * h;
    bool begins = before < 0.0f;
    spring.share = 1.0f;
    spring.part = 1.0f;
    spring.acted = 0.5f;
    spring.closed = 1.0f;
    spring.onset = 0.0f;
    if (begins) {
        spring.share = overlap / (overlap - before);
        spring.acted = spring.share / (0.5f + spring.share);
    }
    precise float stiffness;
    precise float force;
    precise float damping;
    precise float tangential;
    if (HAS(HERTZ)) {
        float disc = sqrt(radius * overlap);
        stiffness = 2.0f * law.x * disc;
        force = 0.66666667f * stiffness * overlap;
        damping = 2.0f * law.y * sqrt(0.83333333f * stiffness * mass);
        tangential = 8.0f * law.z * disc;
        if (!begins && before < overlap) spring.closed = sqrt(before / overlap);
    } else {
        stiffness = 2.0f * law.x * radius;
        force = stiffness * overlap;
        damping = 2.0f * law.y * sqrt(stiffness * mass);
        tangential = 2.0f * law.z * radius;
        // The dashpot sets in with a jump: in the first substep, only for the time since the contact began.
        if (begins) {
            spring.part = 0.5f + spring.share;
            spring.onset = damping * -path;
        }
    }
    // The dashpot sees the mean of the speeds before and after: second order, and never more than what stops the pair.
    precise float c = min(damping * spring.part, 2.0f / (h * mobility));
    precise float impulse = max(h * (force - c * speed) / (1.0f + 0.5f * h * c * mobility), 0.0f);
    spring.impulse = impulse;
    precise float now = impulse / h;
    if (begins) now = max(force - damping * (speed + spring.acted * impulse * mobility), 0.0f);
    spring.now = now;
    spring.stiff = tangential;
    precise float drag = 2.0f * min(law.y, MOST_DRAG) * sqrt(tangential * mass);
    if (HAS(HERTZ)) drag = drag * 0.91287093f;
    spring.drag = drag;
    return spring;
}

// The tangential impulse over a substep. `path` is the slip in the substep's motion, `slip` that before the impulse, both in
// m/s; `mobility` is how much an impulse changes it. `displacement` (m), turned into the plane of the contact, is brought up to
// date.
vec3 tangentialImpulse(vec3 path, vec3 slip, float mobility, Spring spring, float friction) {
    float h = params.substep;
    precise vec3 old = displacement * spring.closed;
    precise vec3 grown = path * (h * (0.5f + 0.5f * spring.closed));
    if (spring.share < 1.0f) {
        old = vec3(0.0f, 0.0f, 0.0f);
        grown = path * (h * spring.share);
        if (HAS(HERTZ)) {
            // The mean of k_t since the contact began.
            grown = grown * 0.66666667f;
        } else {
            // Where the dashpot begins beyond Coulomb's limit.
            float speed = sqrt(dot3(path, path));
            float beyond = spring.drag * speed - friction * spring.onset;
            if (beyond > 0.0f) old = path * (-beyond / (spring.stiff * speed));
        }
    }
    displacement = old + grown;
    // The dashpot sees the mean of the slips before and after.
    precise float weight = -h / (1.0f + 0.5f * h * spring.drag * spring.part * mobility);
    precise vec3 impulse = ((old * spring.part + grown) * spring.stiff + slip * (spring.drag * spring.part)) * weight;
    float squared = dot3(impulse, impulse);
    float most = friction * spring.impulse;
    if (squared <= most * most) return impulse;
    precise vec3 along = impulse * (1.0f / sqrt(squared));
    impulse = along * most;
    precise vec3 sliding = slip + impulse * (mobility * spring.acted);
    displacement = (along * (friction * spring.now) + sliding * spring.drag) * (-1.0f / spring.stiff);
    return impulse;
}

// The overlap when the speeds are reached: they are known half a substep after the places.
float overlapWithSpeed(float overlap, float speed) {
    return max(overlap - speed * (0.5f * params.substep), 0.0f);
}

// J: what the springs of a contact hold.
float springEnergy(float overlap, float radius, vec4 law, vec3 path) {
    if (HAS(HERTZ))
        return sqrt(radius * overlap) * (0.53333333f * law.x * overlap * overlap + 4.0f * law.z * dot3(path, path));
    return radius * (law.x * overlap * overlap + law.z * dot3(path, path));
}

// Into the plane across n, as long as before.
vec3 rotateToPlane(vec3 path, vec3 n) {
    precise vec3 within = path - n * dot3(path, n);
    float was = dot3(path, path);
    float is = dot3(within, within);
    return is > 0.0f ? within * sqrt(was / is) : within;
}
