// Values of several lanes for kernels that do the same work for several pairs or spheres at once: the C++ counterpart
// of the types in shaders/shared/kernel.h. Every operation does for each lane what the scalar kernels do, so that
// results do not depend on the number of lanes.
//
// Included by a translation unit that defines SPHERULE_LANES: 4, 8 or 16. Its compiler options name an instruction set
// with vectors of that size; else the compiler splits them.
#pragma once

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <cmath>
#include <cstdint>
#include <cstring>

#include "compute/cpu/vectors.h"

namespace spherule::compute::cpu::SPHERULE_PRECISION {

#define SPHERULE_INLINE inline __attribute__((always_inline))

constexpr unsigned lanes = SPHERULE_LANES;
using Reals = float __attribute__((vector_size(4 * SPHERULE_LANES)));
using Ints = std::int32_t __attribute__((vector_size(4 * SPHERULE_LANES)));
using Words = std::uint32_t __attribute__((vector_size(4 * SPHERULE_LANES)));

struct mask {
    Ints m;
    mask() = default;
    SPHERULE_INLINE mask(bool all) : m((all ? -1 : 0) - Ints{}) {}
    SPHERULE_INLINE explicit mask(Ints bits) : m(bits) {}
};

struct real {
    Reals v;
    real() = default;
    SPHERULE_INLINE real(float x) : v(x - Reals{}) {}
    SPHERULE_INLINE explicit real(Reals x) : v(x) {}
    SPHERULE_INLINE explicit real(const struct uints& x);
};

// An array, because most of these numbers are addresses: they need no vector.
struct alignas(16) uints {
    std::uint32_t v[lanes];
    uints() = default;
    SPHERULE_INLINE uints(std::uint32_t x) {
        for (unsigned lane = 0; lane < lanes; ++lane) v[lane] = x;
    }
    SPHERULE_INLINE explicit uints(Words x) { std::memcpy(v, &x, sizeof v); }
    [[nodiscard]] SPHERULE_INLINE Words words() const {
        Words x;
        std::memcpy(&x, v, sizeof x);
        return x;
    }
};

// `x`: below 2^31
SPHERULE_INLINE real::real(const uints& x) : v(__builtin_convertvector(reinterpret_cast<Ints>(x.words()), Reals)) {}

// Consecutive numbers, one per lane. `live`: lanes that exist; the numbers of the others may lie beyond a buffer.
struct uintRow {
    std::uint32_t first;
    std::uint32_t live;
};

SPHERULE_INLINE uintRow operator+(uintRow row, std::uint32_t by) {
    return {row.first + by, row.live};
}

#define SPHERULE_REAL_OPERATOR(op)                     \
    SPHERULE_INLINE real operator op(real a, real b) { \
        return real(a.v op b.v);                       \
    }
SPHERULE_REAL_OPERATOR(+)
SPHERULE_REAL_OPERATOR(-)
SPHERULE_REAL_OPERATOR(*)
SPHERULE_REAL_OPERATOR(/)
#undef SPHERULE_REAL_OPERATOR
SPHERULE_INLINE real operator-(real a) {
    return real(-a.v);
}

#define SPHERULE_COMPARISON(op)                        \
    SPHERULE_INLINE mask operator op(real a, real b) { \
        return mask(a.v op b.v);                       \
    }
SPHERULE_COMPARISON(<)
SPHERULE_COMPARISON(>)
SPHERULE_COMPARISON(<=)
SPHERULE_COMPARISON(>=)
SPHERULE_COMPARISON(==)
SPHERULE_COMPARISON(!=)
#undef SPHERULE_COMPARISON

SPHERULE_INLINE mask operator&&(mask a, mask b) {
    return mask(a.m & b.m);
}
SPHERULE_INLINE mask operator||(mask a, mask b) {
    return mask(a.m | b.m);
}
SPHERULE_INLINE mask operator!(mask a) {
    return mask(~a.m);
}
SPHERULE_INLINE mask noLane() {
    return mask(Ints{});
}

#define SPHERULE_UINT_OPERATOR(op)                        \
    SPHERULE_INLINE uints operator op(uints a, uints b) { \
        return uints(a.words() op b.words());             \
    }
SPHERULE_UINT_OPERATOR(+)
SPHERULE_UINT_OPERATOR(*)
SPHERULE_UINT_OPERATOR(^)
SPHERULE_UINT_OPERATOR(&)
#undef SPHERULE_UINT_OPERATOR
SPHERULE_INLINE uints operator>>(uints a, std::uint32_t by) {
    return uints(a.words() >> by);
}

// Bit k is set if lane k is in the mask.
SPHERULE_INLINE std::uint32_t bitsOf(mask a) {
#if SPHERULE_LANES == 4 && defined(__SSE2__)
    return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<__m128>(a.m)));
#elif SPHERULE_LANES == 8 && defined(__AVX__)
    return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(a.m)));
#elif SPHERULE_LANES == 16 && defined(__AVX512DQ__)
    return _mm512_movepi32_mask(reinterpret_cast<__m512i>(a.m));
#else
    std::uint32_t bits = 0;
    for (unsigned k = 0; k < lanes; ++k) bits |= (a.m[k] != 0 ? 1U : 0U) << k;
    return bits;
#endif
}
SPHERULE_INLINE bool anyLane(mask a) {
    return bitsOf(a) != 0;
}
// The lanes below `live`.
SPHERULE_INLINE mask firstLanes(std::uint32_t live) {
    Ints number;
    for (unsigned k = 0; k < lanes; ++k) number[k] = static_cast<std::int32_t>(k);
    return mask(number < (static_cast<std::int32_t>(live) - Ints{}));
}

SPHERULE_INLINE real select(mask where, real yes, real no) {
    return real(where.m ? yes.v : no.v);
}
SPHERULE_INLINE uints select(mask where, uints yes, uints no) {
    return uints(where.m ? yes.words() : no.words());
}
// If an operand is NaN, they choose the same operand as the scalar functions.
SPHERULE_INLINE real min(real a, real b) {
    return select(b < a, b, a);
}
SPHERULE_INLINE real max(real a, real b) {
    return select(a < b, b, a);
}
SPHERULE_INLINE real abs(real a) {
    return real(reinterpret_cast<Reals>(reinterpret_cast<Words>(a.v) & 0x7fffffffU));
}
SPHERULE_INLINE real sqrt(real a) {
#if SPHERULE_LANES == 4 && defined(__SSE2__)
    return real(reinterpret_cast<Reals>(_mm_sqrt_ps(reinterpret_cast<__m128>(a.v))));
#elif SPHERULE_LANES == 8 && defined(__AVX__)
    return real(reinterpret_cast<Reals>(_mm256_sqrt_ps(reinterpret_cast<__m256>(a.v))));
#elif SPHERULE_LANES == 16 && defined(__AVX512F__)
    return real(reinterpret_cast<Reals>(_mm512_sqrt_ps(reinterpret_cast<__m512>(a.v))));
#else
    real root;
    for (unsigned k = 0; k < lanes; ++k) root.v[k] = std::sqrt(a.v[k]);
    return root;
#endif
}

struct real4 {
    real x, y, z, w;
    real4() = default;
    SPHERULE_INLINE real4(real first, real second, real third, real fourth)
        : x(first), y(second), z(third), w(fourth) {}
    SPHERULE_INLINE explicit real4(const vec4& all) : x(all.x), y(all.y), z(all.z), w(all.w) {}
    SPHERULE_INLINE real4(const struct real3& xyz, real fourth);
};

struct real3 {
    real x, y, z;
    real3() = default;
    SPHERULE_INLINE real3(real first, real second, real third) : x(first), y(second), z(third) {}
    SPHERULE_INLINE explicit real3(const real4& xyz) : x(xyz.x), y(xyz.y), z(xyz.z) {}
    SPHERULE_INLINE explicit real3(const vec4& all) : x(all.x), y(all.y), z(all.z) {}
    SPHERULE_INLINE explicit real3(const vec3& all) : x(all.x), y(all.y), z(all.z) {}
};

SPHERULE_INLINE real4::real4(const real3& xyz, real fourth) : x(xyz.x), y(xyz.y), z(xyz.z), w(fourth) {}

SPHERULE_INLINE real3 operator+(const real3& a, const real3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
SPHERULE_INLINE real3 operator-(const real3& a, const real3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
SPHERULE_INLINE real3 operator-(const real3& a) {
    return {-a.x, -a.y, -a.z};
}
SPHERULE_INLINE real3 operator*(const real3& a, const real3& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
SPHERULE_INLINE real3 operator*(const real3& a, real factor) {
    return {a.x * factor, a.y * factor, a.z * factor};
}
SPHERULE_INLINE real3 select(mask where, const real3& yes, const real3& no) {
    return {select(where, yes.x, no.x), select(where, yes.y, no.y), select(where, yes.z, no.z)};
}
SPHERULE_INLINE real4 select(mask where, const real4& yes, const real4& no) {
    return {select(where, yes.x, no.x), select(where, yes.y, no.y), select(where, yes.z, no.z),
            select(where, yes.w, no.w)};
}
SPHERULE_INLINE mask finiteLanes(const real3& a) {
    constexpr float largest = 3.402823466e+38F;
    return abs(a.x) <= largest && abs(a.y) <= largest && abs(a.z) <= largest;
}

// Exchanges rows and columns within each four lanes: four times four columns become four rows, and the reverse.
SPHERULE_INLINE void transpose(Reals& a, Reals& b, Reals& c, Reals& d) {
#if SPHERULE_LANES == 4
#define SPHERULE_SHUFFLE(p, q, i, j, k, l) __builtin_shufflevector(p, q, i, j, (k) + 4, (l) + 4)
#elif SPHERULE_LANES == 8
#define SPHERULE_SHUFFLE(p, q, i, j, k, l) \
    __builtin_shufflevector(p, q, i, j, (k) + 8, (l) + 8, (i) + 4, (j) + 4, (k) + 12, (l) + 12)
#else
#define SPHERULE_SHUFFLE(p, q, i, j, k, l)                                                                          \
    __builtin_shufflevector(p, q, i, j, (k) + 16, (l) + 16, (i) + 4, (j) + 4, (k) + 20, (l) + 20, (i) + 8, (j) + 8, \
                            (k) + 24, (l) + 24, (i) + 12, (j) + 12, (k) + 28, (l) + 28)
#endif
    const Reals t0 = SPHERULE_SHUFFLE(a, b, 0, 1, 0, 1);
    const Reals t1 = SPHERULE_SHUFFLE(a, b, 2, 3, 2, 3);
    const Reals t2 = SPHERULE_SHUFFLE(c, d, 0, 1, 0, 1);
    const Reals t3 = SPHERULE_SHUFFLE(c, d, 2, 3, 2, 3);
    a = SPHERULE_SHUFFLE(t0, t2, 0, 2, 0, 2);
    b = SPHERULE_SHUFFLE(t0, t2, 1, 3, 1, 3);
    c = SPHERULE_SHUFFLE(t1, t3, 0, 2, 0, 2);
    d = SPHERULE_SHUFFLE(t1, t3, 1, 3, 1, 3);
#undef SPHERULE_SHUFFLE
}

// The four floats at `first` + 4 k of each part k of four lanes.
template <class RowAt>
SPHERULE_INLINE Reals rowsFrom(unsigned first, RowAt rowAt) {
#if SPHERULE_LANES == 4
    return rowAt(first);
#elif SPHERULE_LANES == 8
    return __builtin_shufflevector(rowAt(first), rowAt(first + 4), 0, 1, 2, 3, 4, 5, 6, 7);
#else
    using Eight = float __attribute__((vector_size(32)));
    const Eight low = __builtin_shufflevector(rowAt(first), rowAt(first + 4), 0, 1, 2, 3, 4, 5, 6, 7);
    const Eight high = __builtin_shufflevector(rowAt(first + 8), rowAt(first + 12), 0, 1, 2, 3, 4, 5, 6, 7);
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#endif
}

template <class RowAt>
SPHERULE_INLINE real4 gather(RowAt rowAt) {
    Reals a = rowsFrom(0, rowAt);
    Reals b = rowsFrom(1, rowAt);
    Reals c = rowsFrom(2, rowAt);
    Reals d = rowsFrom(3, rowAt);
    transpose(a, b, c, d);
    return {real(a), real(b), real(c), real(d)};
}

// Part `k` of four lanes.
template <unsigned k>
SPHERULE_INLINE Lanes partOf(Reals row) {
#if SPHERULE_LANES == 4
    return row;
#else
    return __builtin_shufflevector(row, row, 4 * k, 4 * k + 1, 4 * k + 2, 4 * k + 3);
#endif
}

// Calls store(lane, row) for the first `live` lanes.
template <class Store>
SPHERULE_INLINE void scatter(const real4& rows, std::uint32_t live, Store store) {
    Reals row[4] = {rows.x.v, rows.y.v, rows.z.v, rows.w.v};
    transpose(row[0], row[1], row[2], row[3]);
    for (unsigned k = 0; k < 4; ++k) {
        if (k < live) store(k, partOf<0>(row[k]));
#if SPHERULE_LANES >= 8
        if (k + 4 < live) store(k + 4, partOf<1>(row[k]));
#endif
#if SPHERULE_LANES == 16
        if (k + 8 < live) store(k + 8, partOf<2>(row[k]));
        if (k + 12 < live) store(k + 12, partOf<3>(row[k]));
#endif
    }
}

// The elements of a buffer in the lanes of `at`. Lanes beyond the live ones have any element. Lanes of `uints` are all
// valid.
SPHERULE_INLINE real4 rowsOf(const vec4* array, const uints& at) {
    return gather([&](unsigned lane) { return array[at.v[lane]].lanes; });
}
SPHERULE_INLINE real4 rowsOf(const vec4* array, uintRow at) {
    if (at.live == lanes) return gather([&](unsigned lane) { return array[at.first + lane].lanes; });
    return gather([&](unsigned lane) { return array[at.first + (lane < at.live ? lane : 0)].lanes; });
}
// The array is padded: its elements beyond the live lanes exist.
SPHERULE_INLINE real rowsOf(const float* array, uintRow at) {
    Reals row;
    std::memcpy(&row, array + at.first, sizeof row);
    return real(row);
}
SPHERULE_INLINE uints rowsOf(const std::uint32_t* array, const uints& at) {
    uints row;
    for (unsigned lane = 0; lane < lanes; ++lane) row.v[lane] = array[at.v[lane]];
    return row;
}
SPHERULE_INLINE uints rowsOf(const std::uint32_t* array, uintRow at) {
    uints row;
    for (unsigned lane = 0; lane < lanes; ++lane) row.v[lane] = array[at.first + (lane < at.live ? lane : 0)];
    return row;
}
// A vec4 member of structs.
template <class T>
SPHERULE_INLINE real4 membersOf(const T* array, const uints& at, vec4 T::*member) {
    return gather([&](unsigned lane) { return (array[at.v[lane]].*member).lanes; });
}

// Sets the elements of the live lanes: `to` where `where` is set, else `old`.
SPHERULE_INLINE void setRows(mask where, vec4* array, const uints& at, const real4& to, const real4& old,
                             std::uint32_t live) {
    const real4 rows = select(where, to, old);
    if (live == lanes)
        scatter(rows, lanes, [&](unsigned lane, Lanes row) { array[at.v[lane]].lanes = row; });
    else
        scatter(rows, live, [&](unsigned lane, Lanes row) { array[at.v[lane]].lanes = row; });
}
SPHERULE_INLINE void setRows(mask where, vec4* array, uintRow at, const real4& to, const real4& old,
                             std::uint32_t /*live*/) {
    const real4 rows = select(where, to, old);
    if (at.live == lanes)
        scatter(rows, lanes, [&](unsigned lane, Lanes row) { array[at.first + lane].lanes = row; });
    else
        scatter(rows, at.live, [&](unsigned lane, Lanes row) { array[at.first + lane].lanes = row; });
}
// The array is padded: its elements beyond the live lanes exist.
SPHERULE_INLINE void setAll(float* array, uintRow at, real to) {
    std::memcpy(array + at.first, &to.v, sizeof to.v);
}

// The largest value of the lanes in `where`, at least 0.
SPHERULE_INLINE float largestOf(mask where, real value) {
    const Reals all = select(where, value, real(0.0F)).v;
    float largest = 0;
    for (unsigned k = 0; k < lanes; ++k) largest = largest < all[k] ? all[k] : largest;
    return largest;
}

// Calls function(number, flag) for each lane in `where`, in order.
template <class Function>
SPHERULE_INLINE void callForLanes(mask where, mask flags, uintRow at, Function function) {
    const std::uint32_t flagBits = bitsOf(flags);
    for (std::uint32_t bits = bitsOf(where); bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::uint32_t>(__builtin_ctz(bits));
        function(at.first + lane, (flagBits >> lane & 1U) != 0);
    }
}
template <class Function>
SPHERULE_INLINE void callForLanes(mask where, const uints& at, Function function) {
    for (std::uint32_t bits = bitsOf(where); bits != 0; bits &= bits - 1)
        function(at.v[static_cast<unsigned>(__builtin_ctz(bits))]);
}
template <class Function>
SPHERULE_INLINE void callForLanes(mask where, uintRow at, Function function) {
    for (std::uint32_t bits = bitsOf(where); bits != 0; bits &= bits - 1)
        function(at.first + static_cast<std::uint32_t>(__builtin_ctz(bits)));
}

}  // namespace spherule::compute::cpu::SPHERULE_PRECISION
