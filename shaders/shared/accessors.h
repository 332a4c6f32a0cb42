// Reads and replaces the values that share a vector with others: the w components of the columns, and the parts of the
// rows of tables. sim/arrays.def lists the columns.

// Returns a row with new x, y and z, and the w of the old row.
vec4 withXyz(vec4 row, vec3 xyz) {
    return vec4(xyz, row.w);
}

// A row of `position`: w is the radius (m). A scene of equal radii has the radius in the parameters too.
float storedRadius(vec4 sphere) {
    return sphere.w;
}

float radiusOf(vec4 sphere) {
    return HAS(RADII) ? sphere.w : params.radius;
}

float radiusSum(vec4 a, vec4 b) {
    return HAS(RADII) ? a.w + b.w : 2.0f * params.radius;
}

float smallerRadius(vec4 a, vec4 b) {
    return HAS(RADII) ? min(a.w, b.w) : params.radius;
}

// A row of `velocity`: w is the inverse mass (1/kg), negative while the sphere is asleep.
bool isAsleep(vec4 v) {
    return v.w < 0.0f;
}

bool isAwake(vec4 v) {
    return v.w > 0.0f;
}

float inverseMassOf(vec4 v) {
    return abs(v.w);
}

// The inverse mass of a sphere that is awake, as all spheres are in the model `accurate`.
float awakeInverseMass(vec4 v) {
    return v.w;
}

// The inverse mass with which a sphere takes part in a contact. It is 0 for a sleeper, so that its neighbours cannot
// move it.
float effectiveInverseMass(vec4 v) {
    return max(v.w, 0.0f);
}

// Puts a sphere to sleep that is awake, and the reverse.
vec4 sleepToggled(vec4 v) {
    return vec4(vec3(v), -v.w);
}

// A row of `velocityBefore`: w is the quiet time, for which the sphere has stayed in one place (s), or MOVED_AWAY.
float quietTimeOf(vec4 before) {
    return before.w;
}

bool hasMovedAway(vec4 before) {
    return before.w == MOVED_AWAY;
}

// A row of `angularVelocity`: w is 1 while the sphere remembers the slip at a wall, in the model `accurate`.
bool remembersWall(vec4 spin) {
    return spin.w != 0.0f;
}

// A row of `tangentialSlip` or `wallSlip`: w is 0 if the row is empty.
bool hasSlip(vec4 slip) {
    return slip.w != 0.0f;
}

// A row of `wallSlip`: w is the number of the surface plus 1.
bool isSlipAt(vec4 slip, uint surface) {
    return slip.w == float(surface + 1u);
}

// A row of `carriedSlip`: w is the id of the partner.
float partnerOf(vec4 slip) {
    return slip.w;
}

// A row of `groupRange`. A group without a list has the round of its samples in place of the first pair.
uint firstPair(uvec4 range) {
    return range.x;
}

uint unlistedRound(uvec4 range) {
    return range.x;
}

uint listedPairs(uvec4 range) {
    return range.y;
}

bool hasList(uvec4 range) {
    return range.y != UNLISTED;
}

uint touchingPairs(uvec4 range) {
    return range.z;
}

bool isActive(uvec4 range) {
    return range.w != 0u;
}

uvec4 withTouching(uvec4 range, uint count) {
    return uvec4(range.x, range.y, count, range.w);
}

// ContactParams.contact
float restitutionOf(vec4 contact) {
    return contact.x;
}

float frictionOf(vec4 contact) {
    return contact.y;
}

float rollingResistanceOf(vec4 contact) {
    return contact.z;
}

float spinningResistanceOf(vec4 contact) {
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
uint idOf(uint word) {
    return word & 0xffffffu;
}

uint materialOf(uint word) {
    return word >> 24u;
}
