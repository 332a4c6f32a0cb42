// The contact law of the model `accurate`: soft spheres. The includer has the PRIVATE variable `displacement`.
//
// Normal force, with overlap d, parting speed v, effective radius R and mass m of the pair:
//      linear spring-dashpot   F = k d - c v,           k = 2 Y R,              c = 2 z sqrt(k m)
//      Hertz                   F = 2/3 S d - c v,       S = 2 Y sqrt(R d),      c = 2 z sqrt(5/6 S m)
// Y is the effective modulus. z is the damping ratio for the required restitution, given that contacts do not pull.
//
// Tangential force, a spring and a dashpot side by side:
//      linear spring-dashpot   F = k_t x + c_t u,       k_t = 2 G R
//      Mindlin                 F = k_t x + c_t u,       k_t = 8 G sqrt(R d)
// u is the slip velocity, x the displacement of the spring and G the effective shear modulus. While the contact sticks,
// x grows with the slip.
//
// While a Hertz contact closes, F stays and x shrinks with 1 / k_t. While it opens, x stays and F falls with k_t. A
// contact therefore never gains energy (Thornton, Cummins and Cleary 2013; `mindlin_rescale` in LAMMPS). F is limited
// to Coulomb's limit. At the limit, the spring takes the rest of the dashpot's force: x = (limit - c_t u) / k_t (Luding
// 2008, Granular Matter 10, 235).
//
// Positions are known at the end of a substep, velocities before and after the impulse that acts there. An impulse
// therefore stands for half a substep before and half a substep after.

// The largest damping ratio at which the tangential dashpot follows the normal one. The limit is there because the
// dashpots of all contacts of a sphere add up.
#define MOST_DRAG 0.3f

// A contact in a substep.
struct Spring {
    float impulse;  // of the normal force (N s), >= 0
    float now;      // normal force at the end of the substep's motion (N)
    float stiff;    // k_t (N/m)
    float drag;     // c_t (N s/m)
    float share;    // share of the motion during which they touched: 1 unless the contact has just begun
    float part;     // share of a substep for which the dashpots' impulse stands: 1 unless it has just begun
    float acted;    // share of the impulse that acts before the end of the motion
    float closed;   // k_t before the motion over k_t now; 1 if the contact opens
    float onset;    // force of the normal dashpot when the contact began (N)
};

// `path` is the normal speed in the substep's motion, `speed` the normal speed before the impulse (m/s). Both are
// positive when the spheres part.
Spring springOf(float overlap, float path, float speed, float radius, float inverseMass, vec4 moduli) {
    Spring spring;
    float h = params.substep;
    precise float mass = 1.0f / inverseMass;
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
        stiffness = 2.0f * normalModulus(moduli) * disc;
        force = 0.66666667f * stiffness * overlap;
        damping = 2.0f * dampingRatio(moduli) * sqrt(0.83333333f * stiffness * mass);
        tangential = 8.0f * tangentialModulus(moduli) * disc;
        if (!begins && before < overlap) spring.closed = sqrt(before / overlap);
    } else {
        stiffness = 2.0f * normalModulus(moduli) * radius;
        force = stiffness * overlap;
        damping = 2.0f * dampingRatio(moduli) * sqrt(stiffness * mass);
        tangential = 2.0f * tangentialModulus(moduli) * radius;
        // The dashpot's force begins with a jump. In the first substep it acts only for the time since the contact
        // began.
        if (begins) {
            spring.part = 0.5f + spring.share;
            spring.onset = damping * -path;
        }
    }
    // The dashpot acts on the mean of the speeds before and after, which is of second order. It never does more than
    // stop the pair.
    precise float c = min(damping * spring.part, 2.0f / (h * inverseMass));
    precise float impulse = max(h * (force - c * speed) / (1.0f + 0.5f * h * c * inverseMass), 0.0f);
    spring.impulse = impulse;
    precise float now = impulse / h;
    if (begins) now = max(force - damping * (speed + spring.acted * impulse * inverseMass), 0.0f);
    spring.now = now;
    spring.stiff = tangential;
    precise float drag = 2.0f * min(dampingRatio(moduli), MOST_DRAG) * sqrt(tangential * mass);
    if (HAS(HERTZ)) drag = drag * 0.91287093f;
    spring.drag = drag;
    return spring;
}

// The tangential impulse over a substep (N s). `path` is the slip in the substep's motion, `slip` the slip before the
// impulse (m/s). `slipPerImpulse` is the change of slip per impulse. Updates `displacement` (m), which must lie in the
// plane of the contact.
vec3 tangentialImpulse(vec3 path, vec3 slip, float slipPerImpulse, Spring spring, float friction) {
    float h = params.substep;
    precise vec3 old = displacement * spring.closed;
    precise vec3 grown = path * (h * (0.5f + 0.5f * spring.closed));
    if (spring.share < 1.0f) {
        old = vec3(0.0f, 0.0f, 0.0f);
        grown = path * (h * spring.share);
        if (HAS(HERTZ)) {
            // The factor accounts for the mean of k_t since the contact began.
            grown = grown * 0.66666667f;
        } else {
            // The displacement if the dashpot begins beyond Coulomb's limit.
            float speed = sqrt(dot3(path, path));
            float beyond = spring.drag * speed - friction * spring.onset;
            if (beyond > 0.0f) old = path * (-beyond / (spring.stiff * speed));
        }
    }
    displacement = old + grown;
    // The dashpot acts on the mean of the slips before and after.
    precise float weight = -h / (1.0f + 0.5f * h * spring.drag * spring.part * slipPerImpulse);
    precise vec3 impulse = ((old * spring.part + grown) * spring.stiff + slip * (spring.drag * spring.part)) * weight;
    float squared = dot3(impulse, impulse);
    float most = friction * spring.impulse;
    if (squared <= most * most) return impulse;
    precise vec3 along = impulse * (1.0f / sqrt(squared));
    impulse = along * most;
    precise vec3 sliding = slip + impulse * (slipPerImpulse * spring.acted);
    displacement = (along * (friction * spring.now) + sliding * spring.drag) * (-1.0f / spring.stiff);
    return impulse;
}

// The overlap (m) at the time of the velocities, which are known half a substep after the positions.
float overlapWithSpeed(float overlap, float speed) {
    return max(overlap - speed * (0.5f * params.substep), 0.0f);
}

// The energy in the springs of a contact (J).
float springEnergy(float overlap, float radius, vec4 moduli, vec3 path) {
    if (HAS(HERTZ))
        return sqrt(radius * overlap) * (0.53333333f * normalModulus(moduli) * overlap * overlap +
                                         4.0f * tangentialModulus(moduli) * dot3(path, path));
    return radius * (normalModulus(moduli) * overlap * overlap + tangentialModulus(moduli) * dot3(path, path));
}

// Turns `path` into the plane with normal n and keeps its length.
vec3 rotateToPlane(vec3 path, vec3 n) {
    precise vec3 within = path - n * dot3(path, n);
    float was = dot3(path, path);
    float is = dot3(within, within);
    return is > 0.0f ? within * sqrt(was / is) : within;
}
