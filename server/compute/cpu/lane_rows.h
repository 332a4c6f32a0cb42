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
SPHERULE_INLINE void setRows(mask where, vec4* array, slots at, const real4& to, const real4& old, std::uint32_t live) {
    const real4 rows = select(where, to, old);
    at.readAnew();
    if (live == lanes)
        scatter(rows, lanes, [&](unsigned lane, Lanes row) { at.rowOf(array, lane).lanes = row; });
    else
        scatter(rows, live, [&](unsigned lane, Lanes row) { at.rowOf(array, lane).lanes = row; });
}
SPHERULE_INLINE void setRows(mask where, vec4* array, uintRow at, const real4& to, const real4& old,
                             std::uint32_t /*live*/) {
    const real4 rows = select(where, to, old);
    vec4* const first = array + at.first;
    if (at.live == lanes)
        scatter(rows, lanes, [&](unsigned lane, Lanes row) { first[lane].lanes = row; });
    else
        scatter(rows, at.live, [&](unsigned lane, Lanes row) { first[lane].lanes = row; });
}
// The array is padded: its elements beyond the live lanes exist.
SPHERULE_INLINE void setAll(float* array, uintRow at, real to) {
    std::memcpy(array + at.first, &to.v, sizeof to.v);
}

// Reads the slots of consecutive pairs. The array is padded.
template <class Pair>
SPHERULE_INLINE void readPairs(const Pair* array, RowOffsets& first, RowOffsets& second) {
    static_assert(sizeof(Pair) == 8 && sizeof(vec4) == 16);
    Words low;
    Words high;
    std::memcpy(&low, array, sizeof low);
    std::memcpy(&high, array + lanes / 2, sizeof high);
#if SPHERULE_LANES == 4
    const Words a = __builtin_shufflevector(low, high, 0, 2, 4, 6);
    const Words b = __builtin_shufflevector(low, high, 1, 3, 5, 7);
#elif SPHERULE_LANES == 8
    const Words a = __builtin_shufflevector(low, high, 0, 2, 4, 6, 8, 10, 12, 14);
    const Words b = __builtin_shufflevector(low, high, 1, 3, 5, 7, 9, 11, 13, 15);
#else
    const Words a = __builtin_shufflevector(low, high, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
    const Words b = __builtin_shufflevector(low, high, 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
#endif
    const Words offsets[] = {a << 4U, b << 4U};
    std::memcpy(first.v, &offsets[0], sizeof first.v);
    std::memcpy(second.v, &offsets[1], sizeof second.v);
}

}  // namespace spherule::compute::cpu::SPHERULE_PRECISION
