// The fields of a scene: forces on every sphere besides gravity and contacts. Field k has its centre in
// params.fieldPlace[k] (m), and in w its strength. params.fieldNumbers[k].w is the kind: the number of the alternative
// in scene::Field, plus 1. The list ends with the first field of no kind.
#define NO_FIELD 0.0f
// Quadratic drag. The strength is 1/2 density coefficient pi (kg/m^3). fieldVector: the velocity of the medium (m/s),
// to which a vortex about the centre adds. fieldSpin: its angular velocity inside the core (rad/s); w: the square of
// its speed at the core (m^2/s^2), above 0.
#define FIELD_DRAG 1.0f
// Attraction to a point. The strength is the scene's (m^3/s^2). fieldNumbers.x: the square of the softening (m^2).
#define FIELD_ATTRACTION 2.0f
// Buoyancy. The strength is density gravity pi / 3 (kg/(m^2 s^2)). The centre is a point of the surface. fieldVector:
// the direction against gravity. fieldNumbers.x: 0, or without a surface BOTTOMLESS.
#define FIELD_BUOYANCY 3.0f
// A spring. The strength is its stiffness (N/m). fieldNumbers.x: its damping (N s/m).
#define FIELD_SPRING 4.0f
// With REGIONS, fieldLow and fieldHigh are the corners of a box (m), with fieldLow.w = IN_BOX. Otherwise fieldLow is the
// middle of a cylinder (m), w: half its length (m); fieldHigh its axis, w: the square of its radius (m^2). A sphere is a
// long cylinder without an axis.

float kindOfField(uint k) {
    return params.fieldNumbers[k].w;
}

float strengthOfField(uint k) {
    return params.fieldPlace[k].w;
}

ANY_REAL partAlong(ANY_REAL3 a, vec3 direction) {
    precise ANY_REAL part = a.x * direction.x + a.y * direction.y + a.z * direction.z;
    return part;
}

// Returns 1 in the region of the field, 0 outside.
RARE ANY_REAL shareOfField(uint k, ANY_REAL3 x) {
    vec3 low = vec3(params.fieldLow[k]);
    vec3 high = vec3(params.fieldHigh[k]);
    if (params.fieldLow[k].w == IN_BOX)
        return select(x.x >= low.x && x.y >= low.y && x.z >= low.z && x.x <= high.x && x.y <= high.y && x.z <= high.z,
                      1.0f, 0.0f);
    precise ANY_REAL3 d = low - x;
    precise ANY_REAL along = partAlong(d, high);
    d.x = d.x - along * high.x;
    d.y = d.y - along * high.y;
    d.z = d.z - along * high.z;
    return select(abs(along) <= params.fieldLow[k].w && dot3(d, d) <= params.fieldHigh[k].w, 1.0f, 0.0f);
}

// Returns the velocity of the medium at x, relative to a sphere with velocity v. The vortex is Rankine's: rigid inside
// the core, outside with a speed in proportion to 1 / distance.
RARE ANY_REAL3 windOn(uint k, ANY_REAL3 x, ANY_REAL3 v) {
    precise ANY_REAL3 around = cross3(vec3(params.fieldPlace[k]) - x, vec3(params.fieldSpin[k]));
    precise ANY_REAL square = dot3(around, around);
    float most = params.fieldSpin[k].w;
    precise ANY_REAL factor = most / select(square > most, square, most);
    precise ANY_REAL3 wind = vec3(params.fieldVector[k]) - v;
    wind = wind + around * factor;
    return wind;
}

// The depth to which the liquid covers a sphere at x, from its lowest point (m).
ANY_REAL depthInLiquid(uint k, ANY_REAL3 x, ANY_REAL radius) {
    precise ANY_REAL depth = partAlong(vec3(params.fieldPlace[k]) - x, vec3(params.fieldVector[k])) + radius;
    depth = depth + params.fieldNumbers[k].x;
    depth = select(depth > 0.0f, depth, 0.0f);
    return select(depth < radius * 2.0f, depth, radius * 2.0f);
}

// Adds to `a` the acceleration (m/s^2) of a sphere at rest at x by the fields, without drag.
ANY_REAL3 withFieldsAt(ANY_REAL3 x, ANY_REAL radius, ANY_REAL inverseOfMass, ANY_REAL3 a) {
    precise ANY_REAL3 sum = a;
    for (uint k = 0u; k < MOST_FIELDS && kindOfField(k) != NO_FIELD; ++k) {
        if (kindOfField(k) == FIELD_ATTRACTION) {
            precise ANY_REAL3 d = vec3(params.fieldPlace[k]) - x;
            precise ANY_REAL square = dot3(d, d) + params.fieldNumbers[k].x;
            precise ANY_REAL factor = strengthOfField(k) / (square * sqrt(square));
            if (HAS(REGIONS)) factor = factor * shareOfField(k, x);
            sum = sum + d * factor;
        }
        if (HAS(BUOYANCY) && kindOfField(k) == FIELD_BUOYANCY) {
            // The volume of a spherical cap is pi h^2 (3 r - h) / 3.
            precise ANY_REAL h = depthInLiquid(k, x, radius);
            precise ANY_REAL lift = h * h * (radius * 3.0f - h) * (inverseOfMass * strengthOfField(k));
            if (HAS(REGIONS)) lift = lift * shareOfField(k, x);
            vec3 up = vec3(params.fieldVector[k]);
            sum.x = sum.x + lift * up.x;
            sum.y = sum.y + lift * up.y;
            sum.z = sum.z + lift * up.z;
        }
        if (HAS(SPRINGS) && kindOfField(k) == FIELD_SPRING) {
            precise ANY_REAL3 d = vec3(params.fieldPlace[k]) - x;
            precise ANY_REAL factor = inverseOfMass * strengthOfField(k);
            if (HAS(REGIONS)) factor = factor * shareOfField(k, x);
            sum = sum + d * factor;
        }
    }
    return sum;
}

// Gravity plus the fields on a sphere at rest at x, without drag (m/s^2).
vec3 accelerationAt(vec3 x, float radius, float inverseOfMass) {
    vec3 a = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(GRAVITY)) a = vec3(params.gravity);
    if (HAS(FIELDS)) a = withFieldsAt(x, radius, inverseOfMass, a);
    return a;
}

// The middle of the path of a substep that begins at x with velocity v. Fields are taken there, which makes the motion
// symplectic: a drift, a kick and a drift.
ANY_REAL3 middleOfPath(ANY_REAL3 x, ANY_REAL3 v) {
    precise ANY_REAL3 middle = x + v * (0.5f * params.substep);
    return middle;
}

// Gravity plus the fields, without drag, on the path of a substep that begins at x with velocity v (m/s^2).
ANY_REAL3 accelerationOnPath(ANY_REAL3 gravity, ANY_REAL3 x, ANY_REAL3 v, ANY_REAL radius, ANY_REAL inverseOfMass) {
    return withFieldsAt(middleOfPath(x, v), radius, inverseOfMass, gravity);
}

// The mean acceleration (m/s^2) in a substep that begins at x with velocity v, with drag and damping besides the
// acceleration `a`. All media and springs act together in one implicit step, at rates (1/s) from the velocity v. So the
// velocity becomes a mean of its value without them and of the velocities of the media, however long the substep is. The
// terminal velocity, where their forces balance `a`, is exact.
ANY_REAL3 withDrag(ANY_REAL3 a, ANY_REAL3 x, ANY_REAL3 v, ANY_REAL radius, ANY_REAL inverseOfMass) {
    bool each = HAS(FLOWS) || HAS(REGIONS);  // else all media act alike
    float drag = 0.0f;
    for (uint k = 0u; k < MOST_FIELDS && kindOfField(k) != NO_FIELD; ++k)
        if (!each && kindOfField(k) == FIELD_DRAG) drag = drag + strengthOfField(k);
    precise ANY_REAL rate = sqrt(dot3(v, v)) * (radius * radius * inverseOfMass * drag);
    precise ANY_REAL3 mean = a - v * rate;
    if (each || HAS(SPRINGS)) {
        for (uint k = 0u; k < MOST_FIELDS && kindOfField(k) != NO_FIELD; ++k) {
            if (each && kindOfField(k) == FIELD_DRAG) {
                precise ANY_REAL3 wind = -v;
                if (HAS(FLOWS)) wind = windOn(k, middleOfPath(x, v), v);
                precise ANY_REAL own = sqrt(dot3(wind, wind)) * (radius * radius * inverseOfMass * strengthOfField(k));
                if (HAS(REGIONS)) own = own * shareOfField(k, middleOfPath(x, v));
                rate = rate + own;
                mean = mean + wind * own;
            }
            if (HAS(SPRINGS) && kindOfField(k) == FIELD_SPRING) {
                precise ANY_REAL own = inverseOfMass * params.fieldNumbers[k].x;
                if (HAS(REGIONS)) own = own * shareOfField(k, middleOfPath(x, v));
                rate = rate + own;
                mean = mean - v * own;
            }
        }
    }
    precise ANY_REAL share = 1.0f / (1.0f + rate * params.substep);
    mean = mean * share;
    return mean;
}

// The mean acceleration (m/s^2) by gravity and all fields in a substep that begins at x with velocity v.
ANY_REAL3 meanAcceleration(ANY_REAL3 gravity, ANY_REAL3 x, ANY_REAL3 v, ANY_REAL radius, ANY_REAL inverseOfMass) {
    return withDrag(accelerationOnPath(gravity, x, v, radius, inverseOfMass), x, v, radius, inverseOfMass);
}

// The potential of the fields (J/kg) on a sphere at x. Outside its region, a field has none. Liquids
// have none above the surface, or without a surface at the highest corner of the bounds.
float fieldPotential(vec3 x, float radius, float inverseOfMass) {
    precise float sum = 0.0f;
    for (uint k = 0u; k < MOST_FIELDS && kindOfField(k) != NO_FIELD; ++k) {
        precise vec3 d = vec3(params.fieldPlace[k]) - x;
        float share = 1.0f;
        if (HAS(REGIONS)) share = shareOfField(k, x);
        if (kindOfField(k) == FIELD_ATTRACTION)
            sum = sum - strengthOfField(k) / sqrt(dot3(d, d) + params.fieldNumbers[k].x) * share;
        if (HAS(SPRINGS) && kindOfField(k) == FIELD_SPRING)
            sum = sum + 0.5f * strengthOfField(k) * inverseOfMass * dot3(d, d) * share;
        if (HAS(BUOYANCY) && kindOfField(k) == FIELD_BUOYANCY) {
            // The integral of the volume of the cap, and of the whole volume below the depth at which it is covered.
            float h = depthInLiquid(k, x, radius);
            float depth = partAlong(d, vec3(params.fieldVector[k]));  // of the centre
            float cap = h * h * h * (radius - 0.25f * h);
            float whole = 4.0f * radius * radius * radius;
            bool bottomless = params.fieldNumbers[k].x != 0.0f;
            float integral = bottomless ? whole * depth : cap + whole * max(depth - radius, 0.0f);
            sum = sum + strengthOfField(k) * inverseOfMass * integral * share;
        }
    }
    return sum;
}
