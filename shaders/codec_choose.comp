// First pass of the codec, one invocation per block: quantises the values of a column, positions or a quantity, and chooses
// predictor and mode. Leaves the new state in `before`, which the host then uses as `newest`. Leaves the packed block to the later passes.
#include "shared/kernel.h"
#include "shared/codec_layout.h"
#include "shared/codec.h"
PARAMETERS

BUFFER(readonly, vec4, source)  // positions; for speeds: velocities; for other quantities: figures; angular velocities
BUFFER(readonly, uint, slotOf)
BUFFER(readonly, uint, order)
BUFFER(readonly, uint, newest)
BUFFER(restrict, uint, before)
BUFFER(writeonly, uint, blockWords)
BUFFER(writeonly, uint, scratch)

PRIVATE(uint, change[CODEC_VALUES])    // new positions less the newest; for the predictor `none`, the positions
PRIVATE(uint, step[CODEC_VALUES])      // the newest positions less the ones before
PRIVATE(uint, residual[CODEC_VALUES])  // of the predictor on trial
PRIVATE(uint, values[CODEC_VALUES])    // the residuals around the base, without signs
PRIVATE(uint, spread[CODEC_RUNS])      // the values of a run, joined by OR
PRIVATE(uint, most[3])                 // the values of an axis, joined by OR
PRIVATE(uint, base[3])
PRIVATE(uint, baseField)

// The best choice so far.
PRIVATE(uint, bestSize)
PRIVATE(uint, bestMode)
PRIVATE(uint, bestPredictor)
PRIVATE(uint, bestBase[3])
PRIVATE(uint, bestField)

#include "shared/codec_pack.h"

// The quantised coordinate. Clamping works on the bits and rounding down avoids floor(), because compilers do not
// vectorise min, max and floor. The bits of NaN are larger than the bits of infinity; NaN is clamped like minus
// infinity.
uint quantise(float x, float origin, float perQuantum) {
    uint bits = floatBitsToUint((x - origin) * perQuantum + 0.5f);
    uint sign = (bits | (0x7f800000u - (floatBitsToUint(x) & 0x7fffffffu))) & 0x80000000u;
    float place = uintBitsToFloat(sign | min(bits & 0x7fffffffu, 0x4e800000u));
    int towardsZero = int(place);
    return uint(towardsZero - int(float(towardsZero) > place));
}

// The image inside the bounds of a coordinate (m) along a periodic axis.
float imageOf(float x, float period) {
    precise float turns = floor(x / period + 0.5f);
    precise float image = x - turns * period;
    return image;
}

// `value` plus or minus `turns`, within half of them of 0. `value` is less than 3/2 of them from 0.
uint nearest(uint value, uint turns) {
    int signedValue = int(value);
    int middle = int(turns >> 1u);
    if (signedValue >= int(turns) - middle) return value - turns;
    if (signedValue < -middle) return value + turns;
    return value;
}

// Moves the coordinates of the block along an axis to their images inside the bounds, before they are quantised.
void takeImages(int first, float period) {
    if (period == 0.0f) return;
    for (int k = first; k < first + 64; ++k)
        change[k] = floatBitsToUint(imageOf(uintBitsToFloat(change[k]), period));
}

// The same for quantised coordinates, which are counted modulo `turns`. A coordinate that is not finite becomes 0.
void countModulo(int first, uint turns) {
    if (turns == 0u) return;
    for (int k = first; k < first + 64; ++k) {
        bool inside = int(change[k]) <= int(turns) && int(change[k]) >= -int(turns);
        change[k] = inside ? nearest(change[k], turns) : 0u;
    }
}

// Indices of the long loops are int: C++ compilers cannot prove that uint indices, which may wrap around, are
// contiguous.

// Writes the slots of the block's spheres to step[].
void takeSlots(int first) {
    if (first + 64 <= int(params.spheres))
        for (int k = 0; k < 64; ++k) step[k] = order[first + k];
    else
        for (int k = 0; k < 64; ++k) step[k] = order[min(uint(first + k), params.spheres - 1u)];
    if (HAS(CONTACTS))
        for (int k = 0; k < 64; ++k) step[k] = slotOf[step[k]];
}

// Prefetches the positions of the next block and the slots of the block after it.
void prefetchAhead(int first) {
    if (first + 192 > int(params.spheres)) return;
    for (int k = first + 64; k < first + 128; ++k) {
        PREFETCH(source[HAS(CONTACTS) ? slotOf[order[k]] : order[k]])
        PREFETCH(slotOf[order[k + 64]])
    }
}

// The code of a value (docs/codec.md): the exponent and the first bits of the mantissa of 1 + value / unit.
uint codeOf(float value) {
    precise float scaled = 1.0f + value * params.perQuantum.x;
    return (floatBitsToUint(scaled) - floatBitsToUint(1.0f)) >> CODEC_VALUE_SHIFT;
}

uint codeOfLength(vec4 v) {
    precise float square = v.x * v.x + v.y * v.y + v.z * v.z;
    return codeOf(sqrt(square));
}

uint codeOfFigure(vec4 row) {
    return codeOf(params.quantity == CODEC_FIGURES ? row.x : params.quantity == CODEC_FIGURES + 1u ? row.y : row.z);
}

// The codes of the magnitudes of three components, with the signs of the components.
void takeSpins(int first) {
    takeSlots(first);
    for (int run = 0; run < 8; ++run)
        for (int k = 0; k < 8; ++k) {
            vec4 spin = source[step[8 * run + k]];
            int lane = 8 * k + run;
            change[lane] = floatBitsToUint(spin.x);
            change[lane + 64] = floatBitsToUint(spin.y);
            change[lane + 128] = floatBitsToUint(spin.z);
        }
    for (int k = 0; k < 192; ++k) {
        uint code = codeOf(uintBitsToFloat(change[k] & 0x7fffffffu)) >> (CODEC_SPIN_SHIFT - CODEC_VALUE_SHIFT);
        change[k] = (change[k] >> 31u) != 0u ? 0u - code : code;
    }
}

void takeValues(int first) {
    takeSlots(first);
    for (int k = 64; k < 192; ++k) change[k] = 0u;
    if (params.quantity == CODEC_LENGTHS) {
        for (int run = 0; run < 8; ++run)
            for (int k = 0; k < 8; ++k) change[8 * k + run] = codeOfLength(source[step[8 * run + k]]);
    } else {
        for (int run = 0; run < 8; ++run)
            for (int k = 0; k < 8; ++k) change[8 * k + run] = codeOfFigure(source[step[8 * run + k]]);
    }
}

void takePositions(int first) {
    takeSlots(first);
    prefetchAhead(first);
    for (int run = 0; run < 8; ++run)
        for (int k = 0; k < 8; ++k) {
            vec4 p = source[step[8 * run + k]];
            int lane = 8 * k + run;
            change[lane] = floatBitsToUint(p.x);
            change[lane + 64] = floatBitsToUint(p.y);
            change[lane + 128] = floatBitsToUint(p.z);
        }
    takeImages(0, params.period.x);
    takeImages(64, params.period.y);
    takeImages(128, params.period.z);
    vec4 grid = params.perQuantum;
    for (int k = 0; k < 64; ++k) change[k] = quantise(uintBitsToFloat(change[k]), params.origin.x, grid.x);
    for (int k = 64; k < 128; ++k) change[k] = quantise(uintBitsToFloat(change[k]), params.origin.y, grid.y);
    for (int k = 128; k < 192; ++k) change[k] = quantise(uintBitsToFloat(change[k]), params.origin.z, grid.z);
    countModulo(0, params.turns.x);
    countModulo(64, params.turns.y);
    countModulo(128, params.turns.z);
}

void predict(uint predictor) {
    uint keptBits = predictor == CODEC_LINEAR ? 0xffffffffu : 0u;
    if (predictor == CODEC_HALF)
        for (int k = 0; k < 192; ++k) residual[k] = change[k] - uint(int(step[k]) >> 1);
    else
        for (int k = 0; k < 192; ++k) residual[k] = change[k] - (step[k] & keptBits);
}

// The values of four residuals of a run around `middle`, joined by OR.
uint spreadOfFour(int k, uint middle) {
    return zigzag(residual[k] - middle) | zigzag(residual[k + 8] - middle) | zigzag(residual[k + 16] - middle) |
           zigzag(residual[k + 24] - middle);
}

// The lanes of a run are eight apart, so that one loop handles all runs of an axis at once.
void takeSpread(int axis, uint middle) {
    uint all = 0u;
    for (int run = 8 * axis; run < 8 * axis + 8; ++run) {
        int k = run + 56 * axis;
        uint bits = spreadOfFour(k, middle) | spreadOfFour(k + 32, middle);
        spread[run] = bits;
        all = all | bits;
    }
    most[axis] = all;
}

// Sets the base to the mean residual of each axis. Residuals are counted from the first one, so that the sum does not
// wrap around.
void takeMean() {
    for (int axis = 0; axis < 3; ++axis) {
        uint sum = 0u;
        for (int k = 64 * axis; k < 64 * axis + 64; ++k) sum += residual[k];
        uint from = residual[64 * axis];
        base[axis] = from + uint(int(sum + 32u - 64u * from) >> 6);
    }
}

// Rounds the base to its field: three numbers of ten bits with a common shift.
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

uint unitsOfMask() {
    uint bits = 24u;
    for (int run = 0; run < 24; ++run) bits += 8u * uint(spread[run] != 0u);
    for (int axis = 0; axis < 3; ++axis) {
        uint changed = 0u;
        uint all = 0u;
        for (int k = 64 * axis; k < 64 * axis + 64; ++k) {
            uint there = uint(residual[k] != 0u);
            changed += there;
            all = all | (zigzag(residual[k]) - there);
        }
        bits += changed * widthOf(codeFor(all));
    }
    return (bits + 15u) / 16u;
}

uint unitsOfRuns() {
    uint least[CODEC_RUNS];
    for (int axis = 0; axis < 3; ++axis) {
        uint narrowest = leastCode(codeFor(most[axis]));  // below 13: codes are equal to widths
        for (int run = 8 * axis; run < 8 * axis + 8; ++run) least[run] = narrowest;
    }
    uint bits = 0u;
    for (int run = 0; run < 24; ++run) bits += max(widthFor(spread[run]), least[run]);
    return (bits * CODEC_RUN + 15u) / 16u;
}

void offer(uint mode, uint predictor, uint units) {
    uint size = 1u + extraUnits(mode, predictor) + units;
    if (size < bestSize) {
        bestSize = size;
        bestMode = mode;
        bestPredictor = predictor;
        for (int axis = 0; axis < 3; ++axis) bestBase[axis] = mode == CODEC_BASE ? base[axis] : 0u;
        bestField = baseField;
    }
}

// Returns false if no position of the block has changed.
bool tryPredictor(uint predictor) {
    predict(predictor);
    takeMean();
    if (predictor != CODEC_NONE) {
        for (int axis = 0; axis < 3; ++axis) takeSpread(axis, 0u);
        if (predictor == CODEC_PREVIOUS && (most[0] | most[1] | most[2]) == 0u) return false;
        uint all = widthFor(most[0]) + widthFor(most[1]) + widthFor(most[2]);
        offer(CODEC_PLAIN, predictor, 4u * all);
        if (all <= CODEC_MASK_WIDTHS) offer(CODEC_MASK, predictor, unitsOfMask());
        offer(CODEC_SELECT, predictor, unitsOfRuns());
        roundBase();
    }
    if (predictor == CODEC_NONE || (base[0] | base[1] | base[2]) != 0u) {
        for (int axis = 0; axis < 3; ++axis) takeSpread(axis, base[axis]);
        offer(CODEC_BASE, predictor, unitsOfRuns());
    }
    return true;
}

void writeBlock(uint block) {
    predict(bestPredictor);
    for (int axis = 0; axis < 3; ++axis) {
        uint middle = bestBase[axis];
        for (int k = 64 * axis; k < 64 * axis + 64; ++k) values[k] = zigzag(residual[k] - middle);
    }
    scratch[block * CODEC_SCRATCH + CODEC_HEADER] = packBlock(block * CODEC_PACKED);
}

// Writes the positions in change[] to `before`, and sets step[]. Then subtracts the newest positions, masked by
// `keptBits`, from change[].
void takeState(int first, uint keptBits) {
    for (int k = 0; k < 192; ++k) {
        uint now = change[k];
        uint last = newest[first + k];
        step[k] = last - before[first + k];
        before[first + k] = now;
        change[k] = now - (last & keptBits);
    }
}

// The shortest way around a periodic axis, for steps, and for changes from the newest positions.
void takeShortest(int first, uint turns, bool changes) {
    if (turns == 0u) return;
    for (int k = first; k < first + 64; ++k) {
        step[k] = nearest(step[k], turns);
        if (changes) change[k] = nearest(change[k], turns);
    }
}

KERNEL(params.blocks) {
    int first = int(invocation * CODEC_VALUES);
    bool alone = params.predictors == 1u << CODEC_NONE;
    if (params.fromState != 0u) {
        for (int k = 0; k < 192; ++k) change[k] = newest[first + k];
        for (int k = 0; k < 192; ++k) step[k] = 0u;
    } else {
        if (params.quantity == CODEC_SPINS)
            takeSpins(int(invocation * CODEC_BLOCK));
        else if (params.quantity != CODEC_POSITIONS)
            takeValues(int(invocation * CODEC_BLOCK));
        else
            takePositions(int(invocation * CODEC_BLOCK));
        takeState(first, alone ? 0u : 0xffffffffu);
        takeShortest(0, params.turns.x, !alone);
        takeShortest(64, params.turns.y, !alone);
        takeShortest(128, params.turns.z, !alone);
    }
    bestSize = 0xffffffffu;
    baseField = 0u;
    bool there = true;
    for (uint predictor = 0u; predictor < 4u && there; ++predictor)
        if ((params.predictors & (1u << predictor)) != 0u) there = tryPredictor(predictor);
    scratch[invocation * CODEC_SCRATCH + CODEC_SIZE] = there ? bestSize : 0u;
    if (there) writeBlock(invocation);
}
