// Reads and replaces the values that share a vector with others: the w components of the columns, and the parts of the
// rows of tables. sim/arrays.def lists the columns.

// Returns a row with new x, y and z, and the w of the old row.
vec4 withXyz(vec4 row, vec3 xyz) {
    return vec4(xyz, row.w);
}

// A row of `position`: w is the radius (m). A scene of equal radii has the radius in the parameters too.
ANY_REAL storedRadius(ANY_REAL4 sphere) {
    return sphere.w;
}

ANY_REAL radiusOf(ANY_REAL4 sphere) {
    return HAS(RADII) ? sphere.w : params.radius;
}

ANY_REAL radiusSum(ANY_REAL4 a, ANY_REAL4 b) {
    return HAS(RADII) ? a.w + b.w : 2.0f * params.radius;
}

ANY_REAL smallerRadius(ANY_REAL4 a, ANY_REAL4 b) {
    return HAS(RADII) ? min(a.w, b.w) : params.radius;
}

// A row of `velocity`: w is the inverse mass (1/kg). It is negative while the sphere is asleep, and 0 if the sphere is
// fixed. A fixed sphere is neither asleep nor awake.
ANY_MASK isAsleep(ANY_REAL4 v) {
    return v.w < 0.0f;
}

// True also if the mass is not finite: the sphere is reported when it moves.
ANY_MASK isAwake(ANY_REAL4 v) {
    return !(v.w <= 0.0f);
}

ANY_MASK isFixed(ANY_REAL4 v) {
    return v.w == 0.0f;
}

ANY_REAL inverseMassOf(ANY_REAL4 v) {
    return abs(v.w);
}

// The inverse mass of a sphere that is awake or fixed, as all spheres are in the model `accurate`.
float awakeInverseMass(vec4 v) {
    return v.w;
}

// The inverse mass with which a sphere takes part in a contact. It is 0 for a sleeper and for a fixed sphere, so that
// their neighbours cannot move them.
ANY_REAL effectiveInverseMass(ANY_REAL4 v) {
    return max(v.w, 0.0f);
}

// Puts a sphere to sleep that is awake, and the reverse.
vec4 sleepToggled(vec4 v) {
    return vec4(vec3(v), -v.w);
}

// A row of `restReference`: w is the quiet time, for which the sphere has been slow (s). It is negative, and less by 1,
// in the substep after the sphere has moved away so far from the reference that it may no longer carry a sleeper.
float quietTimeOf(vec4 rest) {
    return rest.w < 0.0f ? -1.0f - rest.w : rest.w;
}

bool hasMovedAway(vec4 rest) {
    return rest.w < 0.0f;
}

vec4 movedAway(vec3 to, float quietTime) {
    return vec4(to, -1.0f - quietTime);
}

// A row of `angularVelocity`: w is 1 while the sphere remembers the slip at a wall, in the model `accurate`.
bool remembersWall(vec4 spin) {
    return spin.w != 0.0f;
}

// A row of `wallSlip`, or of `wallImpulse`: w is the number of the surface plus 1. It is 0 if the row is empty.
bool hasSlip(vec4 slip) {
    return slip.w != 0.0f;
}

ANY_MASK isAtSurface(ANY_REAL4 row, ANY_UINT surface) {
    return wholeOf(row.w) == surface + 1u;
}

// The surface of a row that is not empty.
uint surfaceOf(vec4 row) {
    return uint(row.w) - 1u;
}

// A row of `unheldVelocity`: w is the number of pairs in which the sphere holds an impulse, plus partOfSurface() of
// each surface at which it holds one. All obstacles have one part together. The sum is exact up to 131,071 pairs.
float partOfSurface(uint surface) {
    return float(1u << min(surface, 6u)) * 0.0078125f;
}

ANY_REAL heldPairs(ANY_REAL parts) {
    return floor(parts);
}

// True if a sum of parts contains the surface's part.
ANY_MASK containsPart(ANY_REAL parts, uint surface) {
    ANY_REAL scaled = parts * float(64u >> min(surface, 6u));
    return scaled - floor(scaled) >= 0.5f;
}

ANY_REAL withPart(ANY_REAL parts, uint surface) {
    return select(containsPart(parts, surface), parts, parts + partOfSurface(surface));
}

// A row of `groupRange`: the candidates of a group of 2 x 2 x 2 cells.
uint firstCandidate(uvec2 range) {
    return range.x;
}

uint candidatesOf(uvec2 range) {
    return range.y;
}

// ContactParams.contact
ANY_REAL restitutionOf(ANY_REAL4 contact) {
    return contact.x;
}

ANY_REAL frictionOf(ANY_REAL4 contact) {
    return contact.y;
}

ANY_REAL rollingResistanceOf(ANY_REAL4 contact) {
    return contact.z;
}

ANY_REAL spinningResistanceOf(ANY_REAL4 contact) {
    return contact.w;
}

// ContactParams.stiffness
float normalModulus(vec4 moduli) {
    return moduli.x;
}

float dampingRatio(vec4 moduli) {
    return moduli.y;
}

float tangentialModulus(vec4 moduli) {
    return moduli.z;
}

// The cells of all levels together, and the first cell of a level. cellsOf() returns the cells of a level.
uint allCells() {
    return params.cells.w;
}

uint firstCell(uvec4 cells) {
    return cells.w;
}

// A row of the table of levels: the largest radius (m).
float largestRadius(uint level) {
    return params.levelSize[level].y;
}

// A row of `idAndMaterial`: the id of the sphere in the low 24 bits, its material above them.
ANY_UINT idOf(ANY_UINT word) {
    return word & 0xffffffu;
}

ANY_UINT materialOf(ANY_UINT word) {
    return word >> 24u;
}

// The own acceleration of a sphere: its words in `accelerationXz` and `accelerationYz` (shared/layout.h). Components lose
// their lowest bits, so that the mean of a constant does not exceed it.
ANY_REAL3 ownAcceleration(ANY_UINT xz, ANY_UINT yz) {
    return real3(uintBitsToFloat(ACCELERATION_X_BITS(xz, yz)), uintBitsToFloat(ACCELERATION_Y_BITS(xz, yz)),
                 uintBitsToFloat(ACCELERATION_Z_BITS(xz, yz)));
}

ANY_UINT accelerationXzOf(ANY_REAL3 a) {
    return (floatBitsToUint(a.x) & ACCELERATION_BITS) | (floatBitsToUint(a.z) >> 21u);
}

ANY_UINT accelerationYzOf(ANY_REAL3 a) {
    return (floatBitsToUint(a.y) & ACCELERATION_BITS) | ((floatBitsToUint(a.z) >> 11u) & 0x3ffu);
}
