// The contact law of the model `balanced`: one visit of each pair in a substep, pair after pair. Each contact begins
// with the impulse that it held at the end of the last substep (a warm start), and corrects it so that the spheres
// neither approach nor slip. A fast approach is an impact, which is exact: the spheres part from the point of impact.
//
// Velocities already contain the substep's gravity and the held impulses (begin_substep.comp). finish_substep.comp
// moves the spheres at the end of the substep, so the law looks ahead by one substep.
//
// Warm starts: Catto, "Iterative Dynamics with Temporal Coherence", 2005. Rigid contacts with a slop, whose overlap is
// removed by moving spheres alone: Catto, "Solver2D", 2024.

// The share of an overlap that a pair removes in a substep. With more than half, columns ring.
#define OVERLAP_REMOVED 0.3f
// The overlap that contacts keep, in radii. Without it they hover at zero and flicker: piles creep.
#define SLOP 0.001f
// An approach is an impact if its speed exceeds two limits. The first is IMPACT times the change of velocity by the
// spheres' own acceleration in a substep. The second is IMPACT_LOAD times the change by the held impulse. Slower
// approaches are the unfinished balance of a pile.
#define IMPACT 2.0f
#define IMPACT_LOAD 5.0f
// The largest impulse that an impact leaves in a contact, over the load that both spheres carry.
#define LOADS_KEPT 1.0f
// A load below this share of an impact is rounding.
#define LEAST_LOAD 1.0e-5f

#define LARGEST_SQUARE 1.0e38f

// A contact with less friction and less restitution than these is soft: a damped spring takes the place of the rigid
// law while the spheres overlap. Frictionless piles have too few constraints for rigid contacts: they never come to
// rest.
#define SOFT_FRICTION 0.05f
#define SOFT_RESTITUTION 0.9f
// The spring has a frequency of 0.2 per substep and a damping ratio of 2 (Catto, "Soft Constraints", 2011), whatever
// the masses are: w = 0.4 pi, a = w (4 + w). In a substep it removes SOFT_REMOVED = w / (4 + w) of the overlap. It
// applies SOFT_SHARE = a / (1 + a) of the impulse that this takes. It gives up SOFT_RELAXED = 1 / (1 + a) of the held
// impulse.
#define SOFT_REMOVED 0.23906f
#define SOFT_SHARE 0.86852f
#define SOFT_RELAXED 0.13148f
// The spring acts up to this gap, in radii. The rigid law closes a gap to zero, with rounding. Rounding must not choose
// the law.
#define SOFT_GAP 1.0e-5f
// The largest overlap that the spring removes in a substep, in radii.
#define SOFT_MOST 0.125f

// The contact of each lane while it is solved: the impulse on the first sphere (N s), and the torque of its friction
// per lever of a sphere (N s). They change from the values of the last substep to the values that the
// contact holds. (A struct would take glslang minutes, because `precise` spreads through its members.)
PRIVATE(real3, heldImpulse)
PRIVATE(real3, heldTorque)
PRIVATE(float, contactReach)  // pairs with a wider gap cannot meet in this substep (m)

// An impact of a pair. All values are along its normal.
struct Approach {
    real3 n;         // from b to a, at the time of the impact
    mask found;      // the paths of the spheres meet within the substep
    real time;       // from the beginning of the substep (s)
    real speed;      // at that time (m/s, negative)
    real late;       // change of the speed by own acceleration and held impulses in the rest of the substep (m/s)
    real solved;     // the present speed (m/s)
};

// Follows two spheres that approach along the mean of their velocities before and after the substep's accelerations.
// `d` and `squared`: the difference of the centres and its square. `relative`: of the present velocities. `before`: of
// the velocities before the substep. `most`: the largest change of the speed that is gravity's.
Approach approachOf(real3 d, real squared, real reach, real3 relative, real3 before, real most) {
    Approach result;
    real h = real(params.substep);
    real3 path = (relative + before) * 0.5f;
    precise real a = dot3(path, path);
    real b = dot3(d, path);  // not `precise`: glslang would need minutes
    precise real discriminant = b * b - a * (squared - reach * reach);
    real root = sqrt(max(discriminant, real(0.0f)));
    precise real meeting = (-b - root) / a;
    result.found = discriminant > 0.0f && meeting <= h;
    real3 n = (d + path * meeting) * (1.0f / reach);
    result.n = n;
    result.solved = dot3(relative, n);
    real start = dot3(before, n);
    precise real gap = -dot3(path, n) * meeting;
    real change = max(min(result.solved - start, real(0.0f)), -most);
    // The speed that the change, spread over the substep, gives over the gap; then the time from both speeds, which
    // keeps a bounce exact to rounding.
    precise real energy = start * start - 2.0f * change * gap * params.perSubstep;
    result.speed = -sqrt(max(energy, real(0.0f)));
    result.time = min(2.0f * gap / max(-start - result.speed, real(1.0e-20f)), h);
    precise real late = change * (1.0f - result.time * params.perSubstep);
    result.late = late;
    return result;
}

// Returns 0 for a value that is negative or not finite.
real positivePart(real value) {
    return select(value > 0.0f && value < LARGEST_SQUARE, value, real(0.0f));
}

mask isSoft(real4 contact) {
    return frictionOf(contact) < SOFT_FRICTION && restitutionOf(contact) < SOFT_RESTITUTION;
}

// The normal impulse of a soft contact of spheres that overlap (N s). `held`: the impulse held before. `speed`: of
// parting (m/s).
real softImpulse(real held, real mass, real speed, real separation, real radius) {
    precise real removed = max(separation * SOFT_REMOVED, -radius * SOFT_MOST) * params.perSubstep;
    precise real impulse = held * (1.0f - SOFT_RELAXED) - mass * SOFT_SHARE * (speed + removed);
    return positivePart(impulse);
}

// The impulse of friction: holds the tangential impulse `held` and stops `slip` (m/s), up to `most` (N s).
real3 frictionOfContact(real3 held, real3 slip, real mass, real most) {
    precise real3 impulse = held - slip * (mass * 0.28571429f);  // 2 / 7: see shared/friction.h
    real squared = dot3(impulse, impulse);
    real factor = select(squared > most * most, most / sqrt(squared), real(1.0f));
    // A sphere whose state is not finite does not affect others.
    return select(squared < LARGEST_SQUARE, impulse * factor, real3(0.0f, 0.0f, 0.0f));
}

// The impulse that a contact holds after an impact (N s). It keeps the impulse `held` before. It also keeps the part
// that an impact without restitution would have added, up to the `load` that both spheres carry.
real heldAfterImpact(real held, real impulse, real restitution, real load) {
    return held + min((impulse - held) / (1.0f + restitution), load * LOADS_KEPT);
}
