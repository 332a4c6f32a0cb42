// Reads and writes elements of buffers for kernels with lanes. Rows of four floats become four values per lane.
#pragma once

#include "compute/cpu/lanes.h"

namespace spherule::compute::cpu::SPHERULE_PRECISION {

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

// The four floats at `first` + 4 k of each part k of four lanes. The intrinsics of AVX load a part and put it in its
// place with one instruction; GCC does not find this one.
template <class RowAt>
SPHERULE_INLINE Reals rowsFrom(unsigned first, RowAt rowAt) {
#if SPHERULE_LANES == 4
    return rowAt(first);
#elif defined(SPHERULE_AVX)
    const __m256 low = _mm256_castps128_ps256(reinterpret_cast<__m128>(rowAt(first)));
    return reinterpret_cast<Reals>(_mm256_insertf128_ps(low, reinterpret_cast<__m128>(rowAt(first + 4)), 1));
#elif defined(SPHERULE_AVX512)
    __m512 row = _mm512_castps128_ps512(reinterpret_cast<__m128>(rowAt(first)));
    row = _mm512_insertf32x4(row, reinterpret_cast<__m128>(rowAt(first + 4)), 1);
    row = _mm512_insertf32x4(row, reinterpret_cast<__m128>(rowAt(first + 8)), 2);
    return reinterpret_cast<Reals>(_mm512_insertf32x4(row, reinterpret_cast<__m128>(rowAt(first + 12)), 3));
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
#elif defined(SPHERULE_AVX)
    return reinterpret_cast<Lanes>(_mm256_extractf128_ps(native(row), k));
#elif defined(SPHERULE_AVX512)
    return reinterpret_cast<Lanes>(_mm512_extractf32x4_ps(native(row), k));
#else
    return __builtin_shufflevector(row, row, 4 * k, 4 * k + 1, 4 * k + 2, 4 * k + 3);
#endif
}

// Calls store(lane, row) for the first `live` of the lanes `first`, `first` + 4, ..., whose rows are the parts of
// `rows`.
template <class Store>
SPHERULE_INLINE void storeParts(Reals rows, unsigned first, std::uint32_t live, Store store) {
    if (first < live) store(first, partOf<0>(rows));
#if SPHERULE_LANES >= 8
    if (first + 4 < live) store(first + 4, partOf<1>(rows));
#endif
#if SPHERULE_LANES == 16
    if (first + 8 < live) store(first + 8, partOf<2>(rows));
    if (first + 12 < live) store(first + 12, partOf<3>(rows));
#endif
}

template <class Store>
SPHERULE_INLINE void storeRows(Reals a, Reals b, Reals c, Reals d, std::uint32_t live, Store store) {
    storeParts(a, 0, live, store);
    storeParts(b, 1, live, store);
    storeParts(c, 2, live, store);
    storeParts(d, 3, live, store);
}

// Calls store(lane, row) for the first `live` lanes: `to` where `where` is set, else `old`. All vectors are variables
// of their own, because GCC keeps them in memory as members of a real4.
template <class Store>
SPHERULE_INLINE void scatter(mask where, const real4& to, const real4& old, std::uint32_t live, Store store) {
    Reals a = select(where, to.x, old.x).v;
    Reals b = select(where, to.y, old.y).v;
    Reals c = select(where, to.z, old.z).v;
    Reals d = select(where, to.w, old.w).v;
    transpose(a, b, c, d);
    if (__builtin_expect(live == lanes, 1))
        storeRows(a, b, c, d, lanes, store);
    else
        storeRows(a, b, c, d, live, store);
}

// The offsets (bytes) of rows of 16 bytes in a buffer. Slots are below 2^24.
struct alignas(4 * lanes) RowOffsets {
    std::uint32_t v[lanes];
};

// Slots of spheres, as the offsets of their rows.
struct slots {
    RowOffsets* offsets;
    SPHERULE_INLINE operator uints() const {
        Words bytes;
        std::memcpy(&bytes, offsets->v, sizeof bytes);
        return uints(bytes >> 4U);
    }
    // Makes the compiler load the offsets again. It would keep copies of them in memory, one for each use.
    SPHERULE_INLINE void readAnew() const { asm volatile("" : "+m"(*offsets)); }
    SPHERULE_INLINE const vec4& rowOf(const vec4* array, unsigned lane) const {
        return *reinterpret_cast<const vec4*>(reinterpret_cast<const char*>(array) + offsets->v[lane]);
    }
    SPHERULE_INLINE vec4& rowOf(vec4* array, unsigned lane) const {
        return *reinterpret_cast<vec4*>(reinterpret_cast<char*>(array) + offsets->v[lane]);
    }
};

// The elements of a buffer in the lanes of `at`. Lanes beyond the live ones have any element. Lanes of `uints` are all
// valid.
SPHERULE_INLINE real4 rowsOf(const vec4* array, const uints& at) {
    return gather([&](unsigned lane) { return array[at.v[lane]].lanes; });
}
SPHERULE_INLINE real4 rowsOf(const vec4* array, slots at) {
    at.readAnew();
    return gather([&](unsigned lane) { return at.rowOf(array, lane).lanes; });
}
SPHERULE_INLINE real4 rowsOf(const vec4* array, uintRow at) {
    const vec4* const rows = array + at.first;
    if (at.live == lanes) return gather([&](unsigned lane) { return rows[lane].lanes; });
    return gather([&](unsigned lane) { return rows[lane < at.live ? lane : 0].lanes; });
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
    if (at.live == lanes)
        std::memcpy(row.v, array + at.first, sizeof row.v);
    else
        for (unsigned lane = 0; lane < lanes; ++lane) row.v[lane] = array[at.first + (lane < at.live ? lane : 0)];
    return row;
}
// A vec4 member of structs.
template <class T>
SPHERULE_INLINE real4 membersOf(const T* array, const uints& at, vec4 T::*member) {
    return gather([&](unsigned lane) { return (array[at.v[lane]].*member).lanes; });
}

// A component of vectors.
SPHERULE_INLINE real membersOf(const vec4* array, slots at, float vec4::*member) {
    Reals row;
    for (unsigned lane = 0; lane < lanes; ++lane) row[lane] = at.rowOf(array, lane).*member;
    return real(row);
}
SPHERULE_INLINE real membersOf(const vec4* array, uintRow at, float vec4::*member) {
    Reals row;
    for (unsigned lane = 0; lane < lanes; ++lane) row[lane] = array[at.first + (lane < at.live ? lane : 0)].*member;
    return real(row);
}

// A member of pairs of numbers.
template <class Pair>
SPHERULE_INLINE uints membersOf(const Pair* array, uintRow at, std::uint32_t Pair::*member) {
    uints row;
    for (unsigned lane = 0; lane < lanes; ++lane) row.v[lane] = array[at.first + (lane < at.live ? lane : 0)].*member;
    return row;
}

// Sets the elements of the live lanes: `to` where `where` is set, else `old`.
SPHERULE_INLINE void setRows(mask where, vec4* array, const uints& at, const real4& to, const real4& old,
                             std::uint32_t live) {
    scatter(where, to, old, live, [&](unsigned lane, Lanes row) { array[at.v[lane]].lanes = row; });
}
SPHERULE_INLINE void setRows(mask where, vec4* array, slots at, const real4& to, const real4& old, std::uint32_t live) {
    at.readAnew();
    scatter(where, to, old, live, [&](unsigned lane, Lanes row) { at.rowOf(array, lane).lanes = row; });
}
SPHERULE_INLINE void setRows(mask where, vec4* array, uintRow at, const real4& to, const real4& old,
                             std::uint32_t /*live*/) {
    vec4* const first = array + at.first;
    scatter(where, to, old, at.live, [&](unsigned lane, Lanes row) { first[lane].lanes = row; });
}
SPHERULE_INLINE void setRows(mask where, std::uint32_t* array, uintRow at, const uints& to, const uints& old,
                             std::uint32_t /*live*/) {
    const uints row = select(where, to, old);
    if (at.live == lanes)
        std::memcpy(array + at.first, row.v, sizeof row.v);
    else
        for (unsigned lane = 0; lane < at.live; ++lane) array[at.first + lane] = row.v[lane];
}
// The array is padded: its elements beyond the live lanes exist.
SPHERULE_INLINE void setAll(float* array, uintRow at, real to) {
    std::memcpy(array + at.first, &to.v, sizeof to.v);
}

struct PairWords {
    Words first;
    Words second;
};
// The numbers of consecutive pairs. The array is padded.
template <class Pair>
SPHERULE_INLINE PairWords pairWordsOf(const Pair* array) {
    static_assert(sizeof(Pair) == 8);
    Words low;
    Words high;
    std::memcpy(&low, array, sizeof low);
    std::memcpy(&high, array + lanes / 2, sizeof high);
#if SPHERULE_LANES == 4
    return {__builtin_shufflevector(low, high, 0, 2, 4, 6), __builtin_shufflevector(low, high, 1, 3, 5, 7)};
#elif SPHERULE_LANES == 8
    return {__builtin_shufflevector(low, high, 0, 2, 4, 6, 8, 10, 12, 14),
            __builtin_shufflevector(low, high, 1, 3, 5, 7, 9, 11, 13, 15)};
#else
    return {__builtin_shufflevector(low, high, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30),
            __builtin_shufflevector(low, high, 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31)};
#endif
}

// Reads the slots of consecutive pairs, without the highest bits. The array is padded.
template <class Pair>
SPHERULE_INLINE void readPairs(const Pair* array, RowOffsets& first, RowOffsets& second) {
    static_assert(sizeof(vec4) == 16);
    const PairWords pairs = pairWordsOf(array);
    const Words offsets[] = {pairs.first << 4U, pairs.second << 4U};
    std::memcpy(first.v, &offsets[0], sizeof first.v);
    std::memcpy(second.v, &offsets[1], sizeof second.v);
}

// Whether the second number of each pair has its highest bit set. The array is padded: lanes beyond the live ones have
// the bits of the next pairs.
template <class Pair>
SPHERULE_INLINE mask highestBits(const Pair* array, uintRow at) {
    const Words words = pairWordsOf(array + at.first).second;
#if defined(SPHERULE_AVX512)
    return mask(_mm512_movepi32_mask(reinterpret_cast<__m512i>(words)));
#else
    return mask(reinterpret_cast<Ints>(words) >> 31);
#endif
}

}  // namespace spherule::compute::cpu::SPHERULE_PRECISION
