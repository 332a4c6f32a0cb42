// The fields of a scene: forces on every sphere besides gravity and contacts. Field k has its centre in
// params.fieldPlace[k] (m), and in w its strength. params.fieldNumbers[k].x is the square of the softening (m^2), and w
// is the kind: the number of the alternative in scene::Field, plus 1. The list ends with the first field of no kind.
#define NO_FIELD 0.0f
// Quadratic drag in a medium at rest. The strength is 1/2 density coefficient pi (kg/m^3).
#define FIELD_DRAG 1.0f
// Attraction to a point. The strength is the scene's (m^3/s^2).
#define FIELD_ATTRACTION 2.0f

float kindOfField(uint k) {
    return params.fieldNumbers[k].w;
}

float strengthOfField(uint k) {
    return params.fieldPlace[k].w;
}

// Adds to `a` the acceleration (m/s^2) of a sphere at rest at x by the fields.
ANY_REAL3 withFieldsAt(ANY_REAL3 x, ANY_REAL3 a) {
    precise ANY_REAL3 sum = a;
    for (uint k = 0u; k < MOST_FIELDS && kindOfField(k) != NO_FIELD; ++k)
        if (kindOfField(k) == FIELD_ATTRACTION) {
            precise ANY_REAL3 d = vec3(params.fieldPlace[k]) - x;
            precise ANY_REAL square = dot3(d, d) + params.fieldNumbers[k].x;
            precise ANY_REAL factor = strengthOfField(k) / (square * sqrt(square));
            sum = sum + d * factor;
        }
    return sum;
}

// Gravity plus the fields on a sphere at rest at x (m/s^2).
vec3 accelerationAt(vec3 x) {
    vec3 a = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(GRAVITY)) a = vec3(params.gravity);
    if (HAS(FIELDS)) a = withFieldsAt(x, a);
    return a;
}

// Gravity plus the fields, without drag, at the middle of the path of a substep that begins at x with velocity v
// (m/s^2). This makes the motion symplectic: a drift, a kick and a drift.
ANY_REAL3 accelerationOnPath(ANY_REAL3 gravity, ANY_REAL3 x, ANY_REAL3 v) {
    precise ANY_REAL3 middle = x + v * (0.5f * params.substep);
    return withFieldsAt(middle, gravity);
}

// The mean acceleration (m/s^2) in a substep that begins with velocity v, with drag besides the acceleration `a`. Drag
// is implicit, so that it never reverses a motion, and the terminal speed is exact.
ANY_REAL3 withDrag(ANY_REAL3 a, ANY_REAL3 v, ANY_REAL radius, ANY_REAL inverseOfMass) {
    float drag = 0.0f;
    for (uint k = 0u; k < MOST_FIELDS && kindOfField(k) != NO_FIELD; ++k)
        if (kindOfField(k) == FIELD_DRAG) drag = drag + strengthOfField(k);
    precise ANY_REAL rate = sqrt(dot3(v, v)) * (radius * radius * inverseOfMass * drag);  // 1/s
    precise ANY_REAL share = 1.0f / (1.0f + rate * params.substep);
    precise ANY_REAL3 mean = (a - v * rate) * share;
    return mean;
}

// The mean acceleration (m/s^2) by gravity and all fields in a substep that begins at x with velocity v.
ANY_REAL3 meanAcceleration(ANY_REAL3 gravity, ANY_REAL3 x, ANY_REAL3 v, ANY_REAL radius, ANY_REAL inverseOfMass) {
    return withDrag(accelerationOnPath(gravity, x, v), v, radius, inverseOfMass);
}

// The potential of the fields at x (J/kg).
float fieldPotential(vec3 x) {
    float sum = 0.0f;
    for (uint k = 0u; k < MOST_FIELDS && kindOfField(k) != NO_FIELD; ++k)
        if (kindOfField(k) == FIELD_ATTRACTION) {
            precise vec3 d = vec3(params.fieldPlace[k]) - x;
            sum = sum - strengthOfField(k) / sqrt(dot3(d, d) + params.fieldNumbers[k].x);
        }
    return sum;
}
