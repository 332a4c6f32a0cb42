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

// Comparisons, selections, min, max and square roots are intrinsics where the instruction set has them: GCC makes up to
// four instructions of the same operations on vector types.
#if SPHERULE_LANES == 16 && defined(__AVX512DQ__)
#define SPHERULE_AVX512
#define SPHERULE_INTRINSIC(operation) _mm512_##operation##_ps
using Native = __m512;
#elif SPHERULE_LANES == 8 && defined(__AVX__)
#define SPHERULE_AVX
#define SPHERULE_INTRINSIC(operation) _mm256_##operation##_ps
using Native = __m256;
#elif SPHERULE_LANES == 4 && defined(__SSE2__)
#define SPHERULE_INTRINSIC(operation) _mm_##operation##_ps
using Native = __m128;
#endif
#if defined(SPHERULE_INTRINSIC)
template <class Vector>
SPHERULE_INLINE Native native(Vector a) {
    return reinterpret_cast<Native>(a);
}
#endif

#if defined(SPHERULE_AVX512)
using MaskBits = std::uint16_t;  // one bit per lane
#else
using MaskBits = Ints;  // 0 or -1 per lane
#endif

struct mask {
    MaskBits m;
    mask() = default;
#if defined(SPHERULE_AVX512)
    SPHERULE_INLINE mask(bool all) : m(all ? 0xffffU : 0U) {}
#else
    SPHERULE_INLINE mask(bool all) : m((all ? -1 : 0) - Ints{}) {}
#endif
    SPHERULE_INLINE explicit mask(MaskBits bits) : m(bits) {}
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

#if defined(SPHERULE_AVX512)
#define SPHERULE_COMPARED(a, op, b, name, predicate) _mm512_cmp_ps_mask(native(a), native(b), predicate)
#elif defined(SPHERULE_AVX)
#define SPHERULE_COMPARED(a, op, b, name, predicate) \
    reinterpret_cast<Ints>(_mm256_cmp_ps(native(a), native(b), predicate))
#elif defined(SPHERULE_INTRINSIC)
#define SPHERULE_COMPARED(a, op, b, name, predicate) \
    reinterpret_cast<Ints>(SPHERULE_INTRINSIC(name)(native(a), native(b)))
#else
#define SPHERULE_COMPARED(a, op, b, name, predicate) (a op b)
#endif
#define SPHERULE_COMPARISON(op, name, predicate)                       \
    SPHERULE_INLINE mask operator op(real a, real b) {                 \
        return mask(SPHERULE_COMPARED(a.v, op, b.v, name, predicate)); \
    }
SPHERULE_COMPARISON(<, cmplt, _CMP_LT_OQ)
SPHERULE_COMPARISON(>, cmpgt, _CMP_GT_OQ)
SPHERULE_COMPARISON(<=, cmple, _CMP_LE_OQ)
SPHERULE_COMPARISON(>=, cmpge, _CMP_GE_OQ)
SPHERULE_COMPARISON(==, cmpeq, _CMP_EQ_OQ)
SPHERULE_COMPARISON(!=, cmpneq, _CMP_NEQ_UQ)
#undef SPHERULE_COMPARISON
#undef SPHERULE_COMPARED

SPHERULE_INLINE mask operator&&(mask a, mask b) {
    return mask(static_cast<MaskBits>(a.m & b.m));
}
SPHERULE_INLINE mask operator||(mask a, mask b) {
    return mask(static_cast<MaskBits>(a.m | b.m));
}
SPHERULE_INLINE mask operator!(mask a) {
    return mask(static_cast<MaskBits>(~a.m));
}
SPHERULE_INLINE mask noLane() {
    return mask(false);
}

#define SPHERULE_UINT_OPERATOR(op)                        \
    SPHERULE_INLINE uints operator op(uints a, uints b) { \
        return uints(a.words() op b.words());             \
    }
SPHERULE_UINT_OPERATOR(+)
SPHERULE_UINT_OPERATOR(*)
SPHERULE_UINT_OPERATOR(^)
SPHERULE_UINT_OPERATOR(&)
SPHERULE_UINT_OPERATOR(|)
#undef SPHERULE_UINT_OPERATOR
SPHERULE_INLINE uints operator>>(uints a, std::uint32_t by) {
    return uints(a.words() >> by);
}
SPHERULE_INLINE uints operator<<(uints a, std::uint32_t by) {
    return uints(a.words() << by);
}

SPHERULE_INLINE mask operator==(const uints& a, const uints& b) {
#if defined(SPHERULE_AVX512)
    return mask(_mm512_cmpeq_epi32_mask(reinterpret_cast<__m512i>(a.words()), reinterpret_cast<__m512i>(b.words())));
#else
    return mask(reinterpret_cast<Ints>(a.words() == b.words()));
#endif
}
SPHERULE_INLINE mask operator!=(const uints& a, const uints& b) {
    return !(a == b);
}
SPHERULE_INLINE std::uint32_t leastOf(const uints& a) {
    std::uint32_t least = a.v[0];
    for (unsigned lane = 1; lane < lanes; ++lane) least = a.v[lane] < least ? a.v[lane] : least;
    return least;
}
// Whole numbers from 0 to 2^24.
SPHERULE_INLINE uints wholeOf(real a) {
    return uints(reinterpret_cast<Words>(__builtin_convertvector(a.v, Ints)));
}
// The numbers whose bits these are.
SPHERULE_INLINE real uintBitsToFloat(const uints& a) {
    return real(reinterpret_cast<Reals>(a.words()));
}

SPHERULE_INLINE uints floatBitsToUint(real a) {
    return uints(reinterpret_cast<Words>(a.v));
}

// Bit k is set if lane k is in the mask.
SPHERULE_INLINE std::uint32_t bitsOf(mask a) {
#if defined(SPHERULE_AVX512)
    return a.m;
#elif defined(SPHERULE_INTRINSIC)
    return static_cast<std::uint32_t>(SPHERULE_INTRINSIC(movemask)(native(a.m)));
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
#if defined(SPHERULE_AVX512)
    return mask(static_cast<MaskBits>((1U << live) - 1U));
#else
    Ints number;
    for (unsigned k = 0; k < lanes; ++k) number[k] = static_cast<std::int32_t>(k);
    return mask(number < (static_cast<std::int32_t>(live) - Ints{}));
#endif
}

// True if the compiler knows that all bits are 0.
SPHERULE_INLINE bool isKnownZero(Words a) {
    for (unsigned k = 0; k < lanes; ++k)
        if (!__builtin_constant_p(a[k]) || a[k] != 0) return false;
    return true;
}
// `yes` in the lanes of the mask, else `no`.
template <class Vector>
SPHERULE_INLINE Vector selected(mask where, Vector yes, Vector no) {
#if defined(SPHERULE_AVX512)
    return reinterpret_cast<Vector>(_mm512_mask_blend_ps(where.m, native(no), native(yes)));
#else
    const auto yesBits = reinterpret_cast<Words>(yes);
    const auto noBits = reinterpret_cast<Words>(no);
    const auto all = reinterpret_cast<Words>(where.m);
#if defined(SPHERULE_AVX)
    if (!isKnownZero(yesBits) && !isKnownZero(noBits))
        return reinterpret_cast<Vector>(_mm256_blendv_ps(native(no), native(yes), native(all)));
#endif
    return reinterpret_cast<Vector>((all & yesBits) | (~all & noBits));
#endif
}
SPHERULE_INLINE real select(mask where, real yes, real no) {
    return real(selected(where, yes.v, no.v));
}
SPHERULE_INLINE real select(mask where, float yes, float no) {
    return select(where, real(yes), real(no));
}
SPHERULE_INLINE uints select(mask where, uints yes, uints no) {
    return uints(selected(where, yes.words(), no.words()));
}
// If an operand is NaN, they choose the same operand as the scalar functions.
SPHERULE_INLINE real min(real a, real b) {
#if defined(SPHERULE_INTRINSIC)
    return real(reinterpret_cast<Reals>(SPHERULE_INTRINSIC(min)(native(b.v), native(a.v))));
#else
    return select(b < a, b, a);
#endif
}
SPHERULE_INLINE real max(real a, real b) {
#if defined(SPHERULE_INTRINSIC)
    return real(reinterpret_cast<Reals>(SPHERULE_INTRINSIC(max)(native(b.v), native(a.v))));
#else
    return select(a < b, b, a);
#endif
}
SPHERULE_INLINE real abs(real a) {
    return real(reinterpret_cast<Reals>(reinterpret_cast<Words>(a.v) & 0x7fffffffU));
}
// `a`: its absolute value is below 2^31
SPHERULE_INLINE real floor(real a) {
    const Reals whole = __builtin_convertvector(__builtin_convertvector(a.v, Ints), Reals);
    return select(a < real(whole), real(whole) - 1.0F, real(whole));
}
SPHERULE_INLINE real sqrt(real a) {
#if defined(SPHERULE_INTRINSIC)
    return real(reinterpret_cast<Reals>(SPHERULE_INTRINSIC(sqrt)(native(a.v))));
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

SPHERULE_INLINE real4 row4(real x, real y, real z, real w) {
    return {x, y, z, w};
}

SPHERULE_INLINE real4::real4(const real3& xyz, real fourth) : x(xyz.x), y(xyz.y), z(xyz.z), w(fourth) {}

SPHERULE_INLINE real3 operator+(const real3& a, const real3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
SPHERULE_INLINE real3 operator-(const real3& a, const real3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
SPHERULE_INLINE real3 operator-(const vec3& a, const real3& b) {
    return real3(a) - b;
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

// The sum over the lanes.
SPHERULE_INLINE float sumOf(real value) {
    float sum = 0;
    for (unsigned k = 0; k < lanes; ++k) sum += value.v[k];
    return sum;
}

// The largest value of the lanes in `where`, at least 0.
SPHERULE_INLINE float largestOf(mask where, real value) {
    const Reals all = select(where, value, real(0.0F)).v;
    float largest = 0;
    for (unsigned k = 0; k < lanes; ++k) largest = largest < all[k] ? all[k] : largest;
    return largest;
}

// The value of one lane.
SPHERULE_INLINE float laneOf(const real& value, std::uint32_t lane) {
    return value.v[lane];
}
SPHERULE_INLINE vec3 laneOf(const real3& value, std::uint32_t lane) {
    return {value.x.v[lane], value.y.v[lane], value.z.v[lane]};
}
SPHERULE_INLINE std::uint32_t& laneOf(uints& value, std::uint32_t lane) {
    return value.v[lane];
}

// Calls function(lane) for each lane in `where`, in order.
template <class Function>
SPHERULE_INLINE void callForLanes(mask where, Function function) {
    for (std::uint32_t bits = bitsOf(where); bits != 0; bits &= bits - 1)
        function(static_cast<std::uint32_t>(__builtin_ctz(bits)));
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
SPHERULE_INLINE void callForLanes(mask where, const uints& at, const real3& a, const real3& b, Function function) {
    for (std::uint32_t bits = bitsOf(where); bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<unsigned>(__builtin_ctz(bits));
        function(at.v[lane], vec3(a.x.v[lane], a.y.v[lane], a.z.v[lane]), vec3(b.x.v[lane], b.y.v[lane], b.z.v[lane]));
    }
}
template <class Function>
SPHERULE_INLINE void callForLanes(mask where, uintRow at, Function function) {
    for (std::uint32_t bits = bitsOf(where); bits != 0; bits &= bits - 1)
        function(at.first + static_cast<std::uint32_t>(__builtin_ctz(bits)));
}

}  // namespace spherule::compute::cpu::SPHERULE_PRECISION
