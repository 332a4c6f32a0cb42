// The codec, first pass, one invocation per block: quantises, chooses predictor and mode, and leaves the new state in
// `before`, which the host then takes for `newest`, and the block's values and header to the passes behind.
#include "shared/kernel.h"
#include "shared/codec_layout.h"
#include "shared/codec.h"
PARAMETERS

BUFFER(0, readonly, vec4, position, PositionBlock)
BUFFER(1, readonly, uint, slotOf, SlotBlock)
BUFFER(2, readonly, uint, order, OrderBlock)
BUFFER(3, readonly, uint, newest, NewestBlock)
BUFFER(4, restrict, uint, before, BeforeBlock)
BUFFER(5, writeonly, uint, values, ValueBlock)
BUFFER(6, writeonly, uint, scratch, ScratchBlock)

PRIVATE(uint, change[CODEC_VALUES])     // new positions less the newest; for the predictor `none` the positions
PRIVATE(uint, step[CODEC_VALUES])       // the newest less those before
PRIVATE(uint, stepShift)                // what a predictor takes of the step
PRIVATE(uint, stepMask)
PRIVATE(uint, spread[CODEC_RUNS])       // all bits of the values of a run
PRIVATE(uint, spreadAround[CODEC_RUNS]) // the same around the base
PRIVATE(uint, most[3])                  // the same of a whole axis
PRIVATE(uint, mostAround[3])
PRIVATE(uint, base[3])
PRIVATE(uint, baseField)

// The best so far.
PRIVATE(uint, bestSize)
PRIVATE(uint, bestMode)
PRIVATE(uint, bestPredictor)

// Clamped by the bits, and rounded down by hand, because compilers make vectors of that but not of min, max and floor. What
// is no number goes where minus infinity goes.
uint quantise(float x, float origin) {
    uint bits = floatBitsToUint((x - origin) * params.grid.w + 0.5f);
    uint sign = (bits & 0x80000000u) | (uint((floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u) << 31u);
    float place = uintBitsToFloat(sign | min(bits & 0x7fffffffu, 0x4e800000u));
    int towardsZero = int(place);
    return uint(towardsZero - int(float(towardsZero) > place));
}

// Indices of the long loops are int: of uint, which may wrap around, C++ compilers do not know that they are contiguous.
void takePositions(uint block) {
    for (uint k = 0u; k < CODEC_BLOCK; ++k) {
        uint id = order[min(block * CODEC_BLOCK + k, params.spheres - 1u)];
        step[k] = HAS(CONTACTS) ? slotOf[id] : id;
    }
    for (uint k = 0u; k < CODEC_BLOCK; ++k) {
        uint ahead = (block + 1u) * CODEC_BLOCK + k;
        uint soon = order[min(ahead, params.spheres - 1u)];
        PREFETCH(position[HAS(CONTACTS) ? slotOf[soon] : soon])
        PREFETCH(slotOf[order[min(ahead + CODEC_BLOCK, params.spheres - 1u)]])
    }
    for (uint k = 0u; k < CODEC_BLOCK; ++k) {
        vec4 p = position[step[k]];
        uint lane = laneOf(k);
        change[lane] = floatBitsToUint(p.x);
        change[lane + 64u] = floatBitsToUint(p.y);
        change[lane + 128u] = floatBitsToUint(p.z);
    }
    for (int k = 0; k < 64; ++k) change[k] = quantise(uintBitsToFloat(change[k]), params.grid.x);
    for (int k = 64; k < 128; ++k) change[k] = quantise(uintBitsToFloat(change[k]), params.grid.y);
    for (int k = 128; k < 192; ++k) change[k] = quantise(uintBitsToFloat(change[k]), params.grid.z);
}

void choosePredictor(uint predictor) {
    stepShift = predictor == CODEC_HALF ? 1u : 0u;
    stepMask = predictor == CODEC_HALF || predictor == CODEC_LINEAR ? 0xffffffffu : 0u;
}

uint residual(int k) {
    return change[k] - (uint(int(step[k]) >> int(stepShift)) & stepMask);
}

// The spread of each run, and as base the mean residual of each axis. The lanes of a run are eight apart, so that halves can
// be folded onto each other.
void takeSpread() {
    for (int axis = 0; axis < 3; ++axis) {
        int first = 64 * axis;
        uint from = residual(first);
        uint bits[32];
        uint sums[32];
        for (int k = 0; k < 32; ++k) {
            uint a = residual(first + k);
            uint b = residual(first + k + 32);
            bits[k] = zigzag(a) | zigzag(b);
            sums[k] = (a - from) + (b - from);
        }
        for (int k = 0; k < 16; ++k) bits[k] = bits[k] | bits[k + 16];
        for (int k = 0; k < 16; ++k) sums[k] = sums[k] + sums[k + 16];
        uint sum = 32u;
        uint all = 0u;
        for (int k = 0; k < 16; ++k) {
            all = all | bits[k];
            sum += sums[k];
        }
        for (int run = 0; run < 8; ++run) spread[8 * axis + run] = bits[run] | bits[run + 8];
        most[axis] = all;
        base[axis] = from + uint(int(sum) >> 6);
    }
}

void takeSpreadAround() {
    for (int axis = 0; axis < 3; ++axis) {
        int first = 64 * axis;
        uint middle = base[axis];
        uint bits[32];
        for (int k = 0; k < 32; ++k)
            bits[k] = zigzag(residual(first + k) - middle) | zigzag(residual(first + k + 32) - middle);
        for (int k = 0; k < 16; ++k) bits[k] = bits[k] | bits[k + 16];
        uint all = 0u;
        for (int k = 0; k < 16; ++k) all = all | bits[k];
        for (int run = 0; run < 8; ++run) spreadAround[8 * axis + run] = bits[run] | bits[run + 8];
        mostAround[axis] = all;
    }
}

// What of the base fits into its field: three times ten bits and a common shift.
void roundBase() {
    uint all = zigzag(base[0]) | zigzag(base[1]) | zigzag(base[2]);
    uint shift = all < 1024u ? 0u : (all < 4096u ? 2u : (all < 16384u ? 4u : 6u));
    baseField = shift << 29u;
    for (uint axis = 0u; axis < 3u; ++axis) {
        int field = int(base[axis]) >> int(shift);
        if (field < -512) field = -512;
        if (field > 511) field = 511;
        base[axis] = uint(field) << shift;
        baseField = baseField | ((uint(field) & 1023u) << (10u * axis));
    }
}

// All bits of the values of an axis that are not 0, less 1.
uint spreadOfChanged(int axis) {
    uint bits = 0u;
    for (int k = 64 * axis; k < 64 * axis + 64; ++k)
        bits = bits | (residual(k) == 0u ? 0u : zigzag(residual(k)) - 1u);
    return bits;
}

uint unitsOfMask() {
    uint bits = 24u;
    for (uint run = 0u; run < CODEC_RUNS; ++run) bits += spread[run] != 0u ? 8u : 0u;
    for (int axis = 0; axis < 3; ++axis) {
        uint changed = 0u;
        for (int k = 64 * axis; k < 64 * axis + 64; ++k) changed += residual(k) != 0u ? 1u : 0u;
        bits += changed * widthOf(codeFor(spreadOfChanged(axis)));
    }
    return (bits + 15u) / 16u;
}

// Width code of a run, where that of its axis is `widest`.
uint codeOfRun(uint widest, uint bits) {
    return max(codeFor(bits), max(widest, 3u) - 3u);
}

uint unitsOfRuns() {
    uint bits = 0u;
    for (int axis = 0; axis < 3; ++axis) {
        uint widest = codeFor(most[axis]);
        for (int run = 8 * axis; run < 8 * axis + 8; ++run) bits += widthOf(codeOfRun(widest, spread[run]));
    }
    return (bits * CODEC_RUN + 15u) / 16u;
}

uint unitsOfRunsAround() {
    uint bits = 0u;
    for (int axis = 0; axis < 3; ++axis) {
        uint widest = codeFor(mostAround[axis]);
        for (int run = 8 * axis; run < 8 * axis + 8; ++run) bits += widthOf(codeOfRun(widest, spreadAround[run]));
    }
    return (bits * CODEC_RUN + 15u) / 16u;
}

void offer(uint mode, uint predictor, uint units) {
    uint size = 1u + extraUnits(mode, predictor) + units;
    if (size < bestSize) {
        bestSize = size;
        bestMode = mode;
        bestPredictor = predictor;
    }
}

// False: nothing has changed.
bool tryPredictor(uint predictor) {
    choosePredictor(predictor);
    takeSpread();
    if (predictor != CODEC_NONE) {
        if (predictor == CODEC_PREVIOUS && (most[0] | most[1] | most[2]) == 0u) return false;
        uint width = widthOf(codeFor(most[0])) + widthOf(codeFor(most[1])) + widthOf(codeFor(most[2]));
        offer(CODEC_PLAIN, predictor, 4u * width);
        if (width <= CODEC_MASK_WIDTHS) offer(CODEC_MASK, predictor, unitsOfMask());
        offer(CODEC_SELECT, predictor, unitsOfRuns());
        roundBase();
    }
    if (predictor == CODEC_NONE || (base[0] | base[1] | base[2]) != 0u) {
        takeSpreadAround();
        offer(CODEC_BASE, predictor, unitsOfRunsAround());
    }
    return true;
}

// Header, selectors and base of what was chosen: the units behind the header begin at a word's low half.
void writeScratch(uint block, bool around) {
    uint at = block * CODEC_SCRATCH;
    uint header = bestMode | (bestPredictor << 2u);
    uint low = 0u;
    uint high = 0u;
    for (uint axis = 0u; axis < 3u; ++axis) {
        uint widest = codeFor(bestMode == CODEC_MASK ? spreadOfChanged(int(axis)) : (around ? mostAround[axis] : most[axis]));
        header = header | (widest << (4u + 4u * axis));
        uint selectors = 0u;
        for (uint run = 0u; run < 8u && bestMode >= CODEC_SELECT; ++run) {
            uint bits = around ? spreadAround[axis * 8u + run] : spread[axis * 8u + run];
            selectors = selectors | ((widest - codeOfRun(widest, bits)) << (2u * run));
        }
        if (axis == 0u) low = selectors;
        if (axis == 1u) low = low | (selectors << 16u);
        if (axis == 2u) high = selectors;
    }
    scratch[at + CODEC_HEADER] = header;
    scratch[at + CODEC_SIZE] = bestSize;
    scratch[at + CODEC_EXTRA] = low;
    if (bestPredictor == CODEC_NONE) {
        scratch[at + CODEC_EXTRA + 1u] = high | (base[0] << 16u);
        scratch[at + CODEC_EXTRA + 2u] = (base[0] >> 16u) | (base[1] << 16u);
        scratch[at + CODEC_EXTRA + 3u] = (base[1] >> 16u) | (base[2] << 16u);
        scratch[at + CODEC_EXTRA + 4u] = base[2] >> 16u;
    } else {
        if (around) high = high | (baseField << 16u);
        scratch[at + CODEC_EXTRA + 1u] = high;
        scratch[at + CODEC_EXTRA + 2u] = baseField >> 16u;
    }
}

void writeBlock(uint block) {
    int first = int(block * CODEC_VALUES);
    bool around = bestMode == CODEC_BASE;
    choosePredictor(bestPredictor);
    takeSpread();
    if (around) {
        if (bestPredictor != CODEC_NONE) roundBase();
        takeSpreadAround();
    } else {
        for (uint axis = 0u; axis < 3u; ++axis) base[axis] = 0u;
        baseField = 0u;
    }
    for (int axis = 0; axis < 3; ++axis) {
        uint middle = base[axis];
        for (int k = 64 * axis; k < 64 * axis + 64; ++k) values[first + k] = zigzag(residual(k) - middle);
    }
    writeScratch(block, around);
}

KERNEL(params.blocks) {
    int first = int(invocation * CODEC_VALUES);
    bool alone = params.predictors == 1u << CODEC_NONE;
    if (params.fromState != 0u)
        for (int k = 0; k < 192; ++k) change[k] = newest[first + k];
    else
        takePositions(invocation);
    for (int k = 0; k < 192; ++k) step[k] = newest[first + k] - before[first + k];
    if (params.fromState == 0u)
        for (int k = 0; k < 192; ++k) before[first + k] = change[k];
    if (!alone)
        for (int k = 0; k < 192; ++k) change[k] = change[k] - newest[first + k];
    bestSize = 0xffffffffu;
    bool there = true;
    for (uint predictor = 0u; predictor < 4u && there; ++predictor)
        if ((params.predictors & (1u << predictor)) != 0u) there = tryPredictor(predictor);
    if (there)
        writeBlock(invocation);
    else
        scratch[invocation * CODEC_SCRATCH + CODEC_SIZE] = 0u;
}
