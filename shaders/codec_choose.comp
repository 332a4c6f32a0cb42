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

PRIVATE(uint, cell[CODEC_VALUES])       // new positions, on the grid
PRIVATE(uint, residual[CODEC_VALUES])
PRIVATE(uint, spread[CODEC_RUNS])       // all bits of the values of a run
PRIVATE(uint, spreadAround[CODEC_RUNS]) // the same around the base
PRIVATE(uint, base[3])
PRIVATE(uint, baseField)

// The best so far.
PRIVATE(uint, bestSize)
PRIVATE(uint, bestMode)
PRIVATE(uint, bestPredictor)

uint quantise(float x, float origin) {
    float place = min(max(floor((x - origin) * params.grid.w + 0.5f), -1073741824.0f), 1073741824.0f);
    bool isNumber = (floatBitsToUint(x) & 0x7fffffffu) <= 0x7f800000u;
    return isNumber ? uint(int(place)) : 0xc0000000u;
}

void takePositions(uint block) {
    for (uint k = 0u; k < CODEC_BLOCK; ++k) {
        uint id = order[min(block * CODEC_BLOCK + k, params.spheres - 1u)];
        vec4 p = position[HAS(CONTACTS) ? slotOf[id] : id];
        cell[k] = floatBitsToUint(p.x);
        cell[k + 64u] = floatBitsToUint(p.y);
        cell[k + 128u] = floatBitsToUint(p.z);
    }
    for (uint k = 0u; k < 64u; ++k) cell[k] = quantise(uintBitsToFloat(cell[k]), params.grid.x);
    for (uint k = 64u; k < 128u; ++k) cell[k] = quantise(uintBitsToFloat(cell[k]), params.grid.y);
    for (uint k = 128u; k < CODEC_VALUES; ++k) cell[k] = quantise(uintBitsToFloat(cell[k]), params.grid.z);
}

void takeResiduals(uint first, uint predictor) {
    if (predictor == CODEC_PREVIOUS)
        for (uint k = 0u; k < CODEC_VALUES; ++k) residual[k] = cell[k] - newest[first + k];
    else if (predictor == CODEC_LINEAR)
        for (uint k = 0u; k < CODEC_VALUES; ++k)
            residual[k] = cell[k] - (2u * newest[first + k] - before[first + k]);
    else if (predictor == CODEC_HALF)
        for (uint k = 0u; k < CODEC_VALUES; ++k)
            residual[k] = cell[k] - newest[first + k] - uint(int(newest[first + k] - before[first + k]) >> 1);
    else
        for (uint k = 0u; k < CODEC_VALUES; ++k) residual[k] = cell[k];
}

// The mean residual of each axis.
void takeMeans() {
    for (uint axis = 0u; axis < 3u; ++axis) {
        uint from = residual[axis * 64u];
        uint sum = 32u;
        for (uint k = axis * 64u; k < axis * 64u + 64u; ++k) sum += residual[k] - from;
        base[axis] = from + uint(int(sum) >> 6);
    }
}

// What of the base fits into its field: three times ten bits and a common shift.
void roundBase() {
    uint most = 0u;
    for (uint axis = 0u; axis < 3u; ++axis) most = most | zigzag(base[axis]);
    uint shift = most < 1024u ? 0u : (most < 4096u ? 2u : (most < 16384u ? 4u : 6u));
    baseField = shift << 29u;
    for (uint axis = 0u; axis < 3u; ++axis) {
        int field = int(base[axis]) >> int(shift);
        if (field < -512) field = -512;
        if (field > 511) field = 511;
        base[axis] = uint(field) << shift;
        baseField = baseField | ((uint(field) & 1023u) << (10u * axis));
    }
}

void takeSpread() {
    for (uint run = 0u; run < CODEC_RUNS; ++run) {
        uint bits = 0u;
        for (uint k = run * CODEC_RUN; k < run * CODEC_RUN + CODEC_RUN; ++k) bits = bits | zigzag(residual[k]);
        spread[run] = bits;
    }
}

void takeSpreadAround() {
    for (uint run = 0u; run < CODEC_RUNS; ++run) {
        uint middle = base[run / 8u];
        uint bits = 0u;
        for (uint k = run * CODEC_RUN; k < run * CODEC_RUN + CODEC_RUN; ++k) bits = bits | zigzag(residual[k] - middle);
        spreadAround[run] = bits;
    }
}

uint ofAxis(uint axis, bool around) {
    uint bits = 0u;
    for (uint run = axis * 8u; run < axis * 8u + 8u; ++run) bits = bits | (around ? spreadAround[run] : spread[run]);
    return bits;
}

// All bits of the values of an axis that are not 0, less 1.
uint spreadOfChanged(uint axis) {
    uint bits = 0u;
    for (uint k = axis * 64u; k < axis * 64u + 64u; ++k)
        bits = bits | (residual[k] == 0u ? 0u : zigzag(residual[k]) - 1u);
    return bits;
}

uint unitsOfMask() {
    uint bits = 24u;
    for (uint run = 0u; run < CODEC_RUNS; ++run) bits += spread[run] != 0u ? 8u : 0u;
    for (uint axis = 0u; axis < 3u; ++axis) {
        uint changed = 0u;
        for (uint k = axis * 64u; k < axis * 64u + 64u; ++k) changed += residual[k] != 0u ? 1u : 0u;
        bits += changed * widthOf(codeFor(spreadOfChanged(axis)));
    }
    return (bits + 15u) / 16u;
}

// Width code of a run, where that of its axis is `most`.
uint codeOfRun(uint most, uint bits) {
    uint code = codeFor(bits);
    return most > code + 3u ? most - 3u : code;
}

uint unitsOfRuns(bool around) {
    uint bits = 0u;
    for (uint axis = 0u; axis < 3u; ++axis) {
        uint most = codeFor(ofAxis(axis, around));
        for (uint run = axis * 8u; run < axis * 8u + 8u; ++run)
            bits += CODEC_RUN * widthOf(codeOfRun(most, around ? spreadAround[run] : spread[run]));
    }
    return (bits + 15u) / 16u;
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
bool tryPredictor(uint first, uint predictor) {
    takeResiduals(first, predictor);
    takeMeans();
    if (predictor != CODEC_NONE) {
        takeSpread();
        uint x = ofAxis(0u, false);
        uint y = ofAxis(1u, false);
        uint z = ofAxis(2u, false);
        if (predictor == CODEC_PREVIOUS && (x | y | z) == 0u) return false;
        uint width = widthOf(codeFor(x)) + widthOf(codeFor(y)) + widthOf(codeFor(z));
        offer(CODEC_PLAIN, predictor, 4u * width);
        if (width <= CODEC_MASK_WIDTHS) offer(CODEC_MASK, predictor, unitsOfMask());
        offer(CODEC_SELECT, predictor, unitsOfRuns(false));
        roundBase();
    }
    if (predictor == CODEC_NONE || (base[0] | base[1] | base[2]) != 0u) {
        takeSpreadAround();
        offer(CODEC_BASE, predictor, unitsOfRuns(true));
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
        uint most = codeFor(bestMode == CODEC_MASK ? spreadOfChanged(axis) : ofAxis(axis, around));
        header = header | (most << (4u + 4u * axis));
        uint selectors = 0u;
        for (uint run = 0u; run < 8u && bestMode >= CODEC_SELECT; ++run) {
            uint bits = around ? spreadAround[axis * 8u + run] : spread[axis * 8u + run];
            selectors = selectors | ((most - codeOfRun(most, bits)) << (2u * run));
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
    uint first = block * CODEC_VALUES;
    bool around = bestMode == CODEC_BASE;
    takeResiduals(first, bestPredictor);
    if (around) {
        takeMeans();
        if (bestPredictor != CODEC_NONE) roundBase();
        takeSpreadAround();
    } else {
        takeSpread();
        for (uint axis = 0u; axis < 3u; ++axis) base[axis] = 0u;
        baseField = 0u;
    }
    for (uint axis = 0u; axis < 3u; ++axis) {
        uint middle = base[axis];
        for (uint k = axis * 64u; k < axis * 64u + 64u; ++k) values[first + k] = zigzag(residual[k] - middle);
    }
    writeScratch(block, around);
}

KERNEL(params.blocks) {
    uint first = invocation * CODEC_VALUES;
    if (params.fromState != 0u)
        for (uint k = 0u; k < CODEC_VALUES; ++k) cell[k] = newest[first + k];
    else
        takePositions(invocation);
    bestSize = 0xffffffffu;
    bool there = true;
    for (uint predictor = 0u; predictor < 4u && there; ++predictor)
        if ((params.predictors & (1u << predictor)) != 0u) there = tryPredictor(first, predictor);
    if (there)
        writeBlock(invocation);
    else
        scratch[invocation * CODEC_SCRATCH + CODEC_SIZE] = 0u;
    if (params.fromState == 0u)
        for (uint k = 0u; k < CODEC_VALUES; ++k) before[first + k] = cell[k];
}
