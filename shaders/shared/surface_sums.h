// Sums over the contacts of the spheres with walls and obstacles, in scenes with contact sums, and over those with driven
// bodies. The sums are integers, so
// that the order in which spheres add to them does not matter. The includer binds `surfaceSums`. Each surface has
// SURFACE_SUM_COPIES rows of SURFACE_SUM_WORDS words, so that few invocations meet at one word. A component has two
// words, low and high, of a number of 64 bits in two's complement.

// The word with the number of contacts of the driven body that is visited.
#define DRIVE_CONTACTS ((driveRow + 2u) * SURFACE_SUM_COPIES * SURFACE_SUM_WORDS)

// A float cannot exceed this number of units, so that its bits fit.
#define MOST_UNITS 4.0e18f

void addToSurfaceSum(uint word, float units) {
    float size = floor(min(abs(units), MOST_UNITS) + 0.5f);
    if (!(size >= 1.0f)) return;  // also if it is not a number
    uint high = uint(size * 2.3283064365386963e-10f);  // 2^-32
    uint low = uint(size - float(high) * 4294967296.0f);
    if (units < 0.0f) {
        low = ~low + 1u;
        high = ~high + (low == 0u ? 1u : 0u);
    }
    uint before = atomicAdd(surfaceSums[word], low);
    uint carry = before + low < before ? 1u : 0u;
    if (high + carry != 0u) atomicAdd(surfaceSums[word + 1u], high + carry);
}

// Adds what a sphere gets from a surface. `number`: chooses the copy. `impulse` in N s. `moment`: of the impulse, about
// the centre of the bounds (N m s).
void addToSurfaceSums(uint number, uint surface, vec3 impulse, vec3 moment) {
    uint word = (surface * SURFACE_SUM_COPIES + number % SURFACE_SUM_COPIES) * SURFACE_SUM_WORDS;
    addToSurfaceSum(word, impulse.x * params.perImpulseUnit);
    addToSurfaceSum(word + 2u, impulse.y * params.perImpulseUnit);
    addToSurfaceSum(word + 4u, impulse.z * params.perImpulseUnit);
    addToSurfaceSum(word + 6u, moment.x * params.perMomentUnit);
    addToSurfaceSum(word + 8u, moment.y * params.perMomentUnit);
    addToSurfaceSum(word + 10u, moment.z * params.perMomentUnit);
}
