// Compares each operation on lanes with the same operation on single values. Compiled once for each number of lanes, so
// it uses no templates that other units share: theirs must not use this unit's instruction set.
#include "compute/cpu/lane_rows.h"

#include "lanes_faults.h"

namespace spherule::compute::cpu::SPHERULE_PRECISION {
namespace {

// Special values, and others of all sizes. NaN is not among the operands of arithmetic: its bits depend on the
// processor.
constexpr float infinity = __builtin_inff();
constexpr float numbers[] = {0.0F,       -0.0F,        1.0F,     -1.0F,     0.3F,         -7.25F,           1e-3F,
                             3.1415927F, 1e30F,        -1e30F,   1e-30F,    1e-40F,       -1e-42F,          16777216.0F,
                             2.5e8F,     -0.99999994F, infinity, -infinity, 1.17549e-38F, 3.402823466e+38F, 123.456F,
                             -5e-5F,     0.1F};
constexpr unsigned count = sizeof numbers / sizeof numbers[0];
constexpr unsigned combinations = count * count;

std::uint32_t bitsOfFloat(float x) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
}

bool same(float a, float b) {
    return bitsOfFloat(a) == bitsOfFloat(b) || (a != a && b != b);
}

bool isSet(mask all, unsigned lane) {
    return (bitsOf(all) >> lane & 1U) != 0;
}

// The mask of the lanes whose numbers leave this remainder.
mask lanesOfRemainder(unsigned remainder, unsigned divisor) {
    real values(0.0F);
    for (unsigned lane = 0; lane < lanes; ++lane) values.v[lane] = lane % divisor == remainder ? 1.0F : 0.0F;
    return values > real(0.0F);
}

const char* first = nullptr;

void check(bool good, const char* operation) {
    if (!good && first == nullptr) first = operation;
}

// The operands of combination `k` of numbers; each lane has another one.
float left(unsigned k) {
    return numbers[k % count];
}
float right(unsigned k) {
    return numbers[k / count % count];
}
real rowOf(float (*operand)(unsigned), unsigned from) {
    real row(0.0F);
    for (unsigned lane = 0; lane < lanes; ++lane) row.v[lane] = operand(from + lane);
    return row;
}

void checkArithmetic(unsigned from) {
    const real a = rowOf(left, from);
    const real b = rowOf(right, from);
    const real sum = a + b;
    const real difference = a - b;
    const real product = a * b;
    const real quotient = a / b;
    const real negative = -a;
    const real root = sqrt(a);
    const real magnitude = abs(a);
    const real whole = floor(a);
    const real smaller = min(a, b);
    const real larger = max(a, b);
    for (unsigned lane = 0; lane < lanes; ++lane) {
        // The compiler cannot know these values, so it computes none of the results itself.
        const volatile float x = left(from + lane);
        const volatile float y = right(from + lane);
        check(same(sum.v[lane], x + y), "+");
        check(same(difference.v[lane], x - y), "-");
        check(same(product.v[lane], x * y), "*");
        check(same(quotient.v[lane], x / y), "/");
        check(same(negative.v[lane], -x), "unary -");
        check(same(root.v[lane], __builtin_sqrtf(x)), "sqrt");
        check(same(magnitude.v[lane], __builtin_fabsf(x)), "abs");
        check(!(__builtin_fabsf(x) < 2147483648.0F) || whole.v[lane] == __builtin_floorf(x), "floor");
        check(same(smaller.v[lane], y < x ? y : x), "min");
        check(same(larger.v[lane], x < y ? y : x), "max");
    }
}

void checkComparisons(const real& a, const real& b) {
    const mask less = a < b;
    const mask greater = a > b;
    const mask atMost = a <= b;
    const mask atLeast = a >= b;
    const mask equal = a == b;
    const mask different = a != b;
    const mask both = less && different;
    const mask either = less || equal;
    const mask reversed = !less;
    const real chosen = select(less, a, b);
    std::uint32_t bits = 0;
    for (unsigned lane = 0; lane < lanes; ++lane) {
        const float x = a.v[lane];
        const float y = b.v[lane];
        check(isSet(less, lane) == (x < y), "<");
        check(isSet(greater, lane) == (x > y), ">");
        check(isSet(atMost, lane) == (x <= y), "<=");
        check(isSet(atLeast, lane) == (x >= y), ">=");
        check(isSet(equal, lane) == (x == y), "==");
        check(isSet(different, lane) == (x != y), "!=");
        check(isSet(both, lane) == (x < y && x != y), "&&");
        check(isSet(either, lane) == (x < y || x == y), "||");
        check(isSet(reversed, lane) == !(x < y), "!");
        check(bitsOfFloat(chosen.v[lane]) == bitsOfFloat(x < y ? x : y), "select");
        bits |= (x < y ? 1U : 0U) << lane;
    }
    check(bitsOf(less) == bits, "bitsOf");
    check(anyLane(less) == (bits != 0), "anyLane");
}

void checkNotANumber() {
    const float none = __builtin_nanf("");
    for (unsigned k = 0; k < count; ++k) {
        const real a(numbers[k]);
        const real b(none);
        checkComparisons(a, b);
        checkComparisons(b, a);
        // The scalar functions keep their first operand.
        check(same(min(a, b).v[0], numbers[k]) && same(max(a, b).v[0], numbers[k]), "min and max with NaN");
        check(same(min(b, a).v[0], none) && same(max(b, a).v[0], none), "min and max of NaN");
    }
    for (unsigned k = 0; k < count; ++k) {
        const real3 p(real(1.0F), real(numbers[k]), real(numbers[count - 1 - k]));
        const bool finite = __builtin_isfinite(numbers[k]) && __builtin_isfinite(numbers[count - 1 - k]);
        check(isSet(finiteLanes(p), lanes - 1) == finite, "finiteLanes");
    }
    check(!anyLane(finiteLanes(real3(real(none), real(0.0F), real(0.0F)))), "finiteLanes of NaN");
}

void checkNumbers(std::uint32_t seed) {
    std::uint32_t x[lanes];
    std::uint32_t y[lanes];
    uints a(0U);
    uints b(0U);
    for (unsigned lane = 0; lane < lanes; ++lane) {
        seed = seed * 1664525U + 1013904223U;
        a.v[lane] = x[lane] = seed;
        seed = seed * 1664525U + 1013904223U;
        b.v[lane] = y[lane] = seed;
    }
    const uints sum = a + b;
    const uints product = a * b;
    const uints exclusive = a ^ b;
    const uints common = a & b;
    const uints shifted = a >> 15U;
    const real asReals(a & 0xffffffU);
    for (unsigned lane = 0; lane < lanes; ++lane) {
        check(sum.v[lane] == x[lane] + y[lane], "+ of numbers");
        check(product.v[lane] == x[lane] * y[lane], "* of numbers");
        check(exclusive.v[lane] == (x[lane] ^ y[lane]), "^");
        check(common.v[lane] == (x[lane] & y[lane]), "&");
        check(shifted.v[lane] == x[lane] >> 15U, ">>");
        check(asReals.v[lane] == static_cast<float>(x[lane] & 0xffffffU), "real of a number");
    }
    const mask chosen = lanesOfRemainder(0, 3);
    const uints either = select(chosen, a, b);
    for (unsigned lane = 0; lane < lanes; ++lane)
        check(either.v[lane] == (lane % 3 == 0 ? x[lane] : y[lane]), "select of numbers");
}

constexpr unsigned elements = 3 * lanes + 5;
vec4 rows[elements];
float reals[elements];
std::uint32_t words[elements];

struct Pair {
    vec4 one;
    vec4 other;
};
Pair structs[elements];
struct Slots {
    std::uint32_t first;
    std::uint32_t second;
};
Slots listed[lanes];

void fill() {
    for (unsigned k = 0; k < elements; ++k) {
        const auto x = static_cast<float>(k);
        rows[k] = vec4(x, x + 0.25F, x + 0.5F, x + 0.75F);
        reals[k] = -x;
        words[k] = 7 * k;
        structs[k] = {vec4(-x, 0, 0, 0), vec4(x, 2 * x, 3 * x, 4 * x)};
    }
}

bool isRow(const real4& found, unsigned lane, unsigned number) {
    const auto x = static_cast<float>(number);
    return found.x.v[lane] == x && found.y.v[lane] == x + 0.25F && found.z.v[lane] == x + 0.5F &&
           found.w.v[lane] == x + 0.75F;
}

// `live` lanes read and write; the places are in another order than the lanes.
void checkRows(std::uint32_t live) {
    fill();
    uints at(0U);
    for (unsigned lane = 0; lane < lanes; ++lane) at.v[lane] = (lane * 5 + 3) % elements;
    const uintRow row{lanes + 2, live};
    const real4 gathered = rowsOf(rows, at);
    const real4 inRow = rowsOf(rows, row);
    const real4 member = membersOf(structs, at, &Pair::other);
    const real single = rowsOf(reals, row);
    const uints numbered = rowsOf(words, at);
    const uints numberedRow = rowsOf(words, row);
    for (unsigned lane = 0; lane < lanes; ++lane) {
        check(isRow(gathered, lane, at.v[lane]), "rowsOf");
        check(member.w.v[lane] == 4 * static_cast<float>(at.v[lane]), "membersOf");
        check(numbered.v[lane] == 7 * at.v[lane], "rowsOf words");
        if (lane >= live) continue;
        check(isRow(inRow, lane, row.first + lane), "rowsOf a row");
        check(single.v[lane] == -static_cast<float>(row.first + lane), "rowsOf floats");
        check(numberedRow.v[lane] == 7 * (row.first + lane), "rowsOf words in a row");
        check((numberedRow << 3U).v[lane] == 56 * (row.first + lane), "shift to the left");
        check(uintBitsToFloat(floatBitsToUint(single)).v[lane] == single.v[lane], "floatBitsToUint");
        check(floatBitsToUint(real(-1.5F)).v[lane] == 0xbfc00000U, "floatBitsToUint of -1.5");
    }

    const mask where = lanesOfRemainder(0, 2);
    const real4 to(real(-1.0F), real(-2.0F), real(-3.0F), real(-4.0F));
    setRows(where, rows, at, to, gathered, live);
    for (unsigned k = 0; k < elements; ++k) {
        bool changed = false;
        for (unsigned lane = 0; lane < live; ++lane) changed = changed || (lane % 2 == 0 && at.v[lane] == k);
        check(rows[k].x == (changed ? -1 : static_cast<float>(k)), "setRows");
        check(rows[k].w == (changed ? -4 : static_cast<float>(k) + 0.75F), "setRows, last component");
    }
    fill();
    setRows(where, rows, row, to, inRow, live);
    for (unsigned k = 0; k < elements; ++k) {
        const bool changed = k >= row.first && k < row.first + live && (k - row.first) % 2 == 0;
        check(rows[k].y == (changed ? -2 : static_cast<float>(k) + 0.25F), "setRows of a row");
    }
    setRows(where, words, row, uints(3U), numberedRow, live);
    for (unsigned k = 0; k < elements; ++k) {
        const bool changed = k >= row.first && k < row.first + live && (k - row.first) % 2 == 0;
        check(words[k] == (changed ? 3 : 7 * k), "setRows of words in a row");
    }
    setAll(reals, row, real(5.0F));
    for (unsigned k = 0; k < elements; ++k)
        check(reals[k] == (k >= row.first && k < row.first + lanes ? 5.0F : -static_cast<float>(k)), "setAll");

    check(bitsOf(firstLanes(live)) == (1ULL << live) - 1, "firstLanes");
    std::uint32_t called = 0;
    callForLanes(where && firstLanes(live), row, [&](std::uint32_t number) { called |= 1U << (number - row.first); });
    check(called == (bitsOf(where) & bitsOf(firstLanes(live))), "callForLanes");
    unsigned calls = 0;
    callForLanes(where, at, [&](std::uint32_t number) {
        while ((bitsOf(where) >> calls & 1U) == 0) ++calls;
        check(number == at.v[calls++], "callForLanes with numbers");
    });
}

void checkSlots(std::uint32_t live) {
    fill();
    for (unsigned lane = 0; lane < lanes; ++lane)
        listed[lane] = {(lane * 5 + 3) % elements, (lane * 7 + 1) % elements + (lane % 3 == 0 ? 0x80000000U : 0)};
    const mask highest = highestBits(listed, uintRow{.first = 0, .live = live});
    RowOffsets offsets[2];
    readPairs(listed, offsets[0], offsets[1]);
    for (unsigned lane = 0; lane < lanes; ++lane) {
        check((bitsOf(highest) >> lane & 1U) == (lane % 3 == 0 ? 1U : 0U), "highestBits");
        listed[lane].second &= 0x7fffffffU;
    }
    const slots a{&offsets[0]};
    const slots b{&offsets[1]};
    const real4 gathered = rowsOf(rows, b);
    for (unsigned lane = 0; lane < lanes; ++lane) {
        check(uints(a).v[lane] == listed[lane].first, "readPairs, first");
        check(uints(b).v[lane] == listed[lane].second, "readPairs, second");
        check(isRow(gathered, lane, listed[lane].second), "rowsOf slots");
    }
    const mask where = lanesOfRemainder(0, 2);
    setRows(where, rows, b, real4(real(-1.0F), real(-2.0F), real(-3.0F), real(-4.0F)), gathered, live);
    for (unsigned k = 0; k < elements; ++k) {
        bool changed = false;
        for (unsigned lane = 0; lane < live; lane += 2) changed = changed || listed[lane].second == k;
        check(rows[k].y == (changed ? -2 : static_cast<float>(k) + 0.25F), "setRows of slots");
    }
}

void checkLargest() {
    real values(0.0F);
    for (unsigned lane = 0; lane < lanes; ++lane) values.v[lane] = static_cast<float>((lane * 7 + 5) % lanes) + 1;
    for (unsigned excluded = 0; excluded < lanes; ++excluded) {
        float largest = 0;
        const mask where = !lanesOfRemainder(excluded, lanes);
        for (unsigned lane = 0; lane < lanes; ++lane)
            if (lane != excluded && values.v[lane] > largest) largest = values.v[lane];
        check(largestOf(where, values) == largest, "largestOf");
    }
    check(largestOf(noLane(), values) == 0, "largestOf no lane");
}

}  // namespace

const char* firstFault() {
    first = nullptr;
    for (unsigned from = 0; from < combinations; ++from) {
        checkArithmetic(from);
        checkComparisons(rowOf(left, from), rowOf(right, from));
        checkNumbers(from);
    }
    checkNotANumber();
    for (std::uint32_t live = 1; live <= lanes; ++live) {
        checkRows(live);
        checkSlots(live);
    }
    checkLargest();
    return first;
}

}  // namespace spherule::compute::cpu::SPHERULE_PRECISION
