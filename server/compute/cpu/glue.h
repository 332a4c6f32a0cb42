// Compiles a .comp file as C++: the file is included in the body of a struct. The counterpart of
// shaders/shared/kernel.h. Buffers are members that point into the slots of a launch. So there are no globals, and
// several simulations can run at once. Only one thread at a time may use an object, because PRIVATE variables are
// members too.
//
// Included once by each translation unit that compiles the kernels. The unit first defines:
//   SPHERULE_REAL        The type for `float` in kernels: float or double, or a class of the tests.
//   SPHERULE_REAL_FUNCTIONS  Only if that class has abs(), floor() and sqrt().
//   SPHERULE_PRECISION   The namespace of the kernels, which contains vec3 and vec4 of that type.
//   SPHERULE_LANES       Only in units of kernels with several lanes, which include compute/cpu/lane_rows.h before.

// Kernels share callbacks whose parameters some kernels do not use, and Mesa refuses a parameter without a name.
#pragma GCC diagnostic ignored "-Wunused-parameter"

#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "compute/cpu/features.h"
#include "compute/cpu/kernels.h"

namespace spherule::compute::cpu::SPHERULE_PRECISION {

using Scalar = SPHERULE_REAL;
using glm::uvec2;
using glm::uvec4;
using uint = std::uint32_t;

// GLSL's scalar functions. If an operand is NaN, they choose the same operand as GLSL.
inline Scalar min(Scalar a, Scalar b) {
    return b < a ? b : a;
}
inline Scalar max(Scalar a, Scalar b) {
    return a < b ? b : a;
}
inline uint min(uint a, uint b) {
    return b < a ? b : a;
}
inline uint max(uint a, uint b) {
    return a < b ? b : a;
}
inline Scalar clamp(Scalar x, Scalar low, Scalar high) {
    return min(max(x, low), high);
}
#if !defined(SPHERULE_REAL_FUNCTIONS)
inline Scalar abs(Scalar x) {
    return std::fabs(x);
}
inline Scalar floor(Scalar x) {
    return std::floor(x);
}
inline Scalar sqrt(Scalar x) {
    return std::sqrt(x);
}
#endif
inline Scalar uintBitsToFloat(uint x) {
    return static_cast<Scalar>(std::bit_cast<float>(x));
}
inline uint floatBitsToUint(Scalar x) {
    return std::bit_cast<uint>(static_cast<float>(x));
}
// Return the index of the highest and of the lowest set bit; -1 if no bit is set.
inline int findMSB(uint x) {
    return 31 - std::countl_zero(x);
}
inline int findLSB(uint x) {
    return x == 0 ? -1 : std::countr_zero(x);
}

// The types and functions of kernels with lanes, for one lane.
inline Scalar select(bool where, Scalar yes, Scalar no) {
    return where ? yes : no;
}
inline uint select(bool where, uint yes, uint no) {
    return where ? yes : no;
}
inline vec3 select(bool where, const vec3& yes, const vec3& no) {
    return where ? yes : no;
}
inline vec4 select(bool where, const vec4& yes, const vec4& no) {
    return where ? yes : no;
}
inline vec4 row4(Scalar x, Scalar y, Scalar z, Scalar w) {
    return {x, y, z, w};
}
inline bool anyLane(bool a) {
    return a;
}
#if !defined(SPHERULE_LANES)
using real = Scalar;
using real3 = vec3;
using real4 = vec4;
using mask = bool;
using uints = uint;
using slots = uint;
using uintRow = uint;
inline bool noLane() {
    return false;
}
inline bool liveLanes() {
    return true;
}
inline uint leastOf(uint a) {
    return a;
}
inline uint wholeOf(Scalar a) {
    return static_cast<uint>(a);
}
inline bool finiteLanes(const vec3& a) {
    constexpr Scalar largest = std::numeric_limits<float>::max();
    return abs(a.x) <= largest && abs(a.y) <= largest && abs(a.z) <= largest;
}
#endif

inline uint atomicAdd(uint& memory, uint value) {
    return std::atomic_ref<uint>(memory).fetch_add(value, std::memory_order_relaxed);
}

// Writes only if the value changes: thousands of invocations raise one flag, and each write would take the cache line
// from the other threads.
inline uint atomicOr(uint& memory, uint value) {
    const std::atomic_ref<uint> word(memory);
    const uint seen = word.load(std::memory_order_relaxed);
    return (seen & value) == value ? seen : word.fetch_or(value, std::memory_order_relaxed);
}

inline uint atomicExchange(uint& memory, uint value) {
    const std::atomic_ref<uint> word(memory);
    const uint seen = word.load(std::memory_order_relaxed);
    return seen == value ? seen : word.exchange(value, std::memory_order_relaxed);
}

inline uint atomicMax(uint& memory, uint value) {
    const std::atomic_ref<uint> word(memory);
    uint seen = word.load(std::memory_order_relaxed);
    while (seen < value && !word.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
    }
    return seen;
}

// Another thread may be writing the word.
inline uint wordOf(uint& memory) {
    return std::atomic_ref<uint>(memory).load(std::memory_order_relaxed);
}

// The base class of the struct around a .comp file.
struct KernelBase : Features {
    explicit KernelBase(const Binding& bound) : binding(bound), phase(bound.phase) {}

    template <class T>
    [[nodiscard]] T* slot(std::size_t number) const {
        return number < binding.slots.size() ? static_cast<T*>(binding.slots[number]) : nullptr;
    }

    // Returns the slot of the buffer `name` in the kernel's declarations.
    template <std::size_t count>
    static consteval std::size_t placeAmong(const BufferDeclaration (&declared)[count], std::string_view name) {
        std::size_t slot = 0;
        while (declared[slot].name != name) ++slot;
        return slot;
    }

    // Returns a copy, so that the compiler knows that no buffer overlaps it.
    template <class T>
    [[nodiscard]] T copyOfParameters() const {
        T copy{};
        if (binding.parameters != nullptr) std::memcpy(static_cast<void*>(&copy), binding.parameters, sizeof copy);
        return copy;
    }

#if defined(SPHERULE_LANES)
    [[nodiscard]] SPHERULE_INLINE mask liveLanes() const {
        return firstLanes(live);
    }
#endif

    static constexpr uint firstThread = 0;  // the only one

    Binding binding;
    uint phase;
#if defined(SPHERULE_LANES)
    uint live = 0;  // lanes at work
#endif
};

template <class Kernel>
uint countOf(const Binding& binding) {
    return Kernel(binding).kernelCount();
}

// Compiles a second version for processors with AVX2; the loader chooses. Neither version contracts a multiplication
// with an addition, so both give the same bits. Not with sanitizers: their runtimes start after the loader has chosen.
#if defined(__x86_64__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SPHERULE_CLONES __attribute__((target_clones("arch=x86-64-v3", "default"), flatten))
#else
#define SPHERULE_CLONES
#endif

#if defined(SPHERULE_LANES)
template <class Kernel>
__attribute__((flatten)) void run(const Binding& binding, uint begin, uint end) {
    Kernel kernel(binding);
    if constexpr (requires { kernel.kernelRows(uintRow{}); }) {
        for (uint first = begin; first < end; first += lanes) {
            kernel.live = min(end - first, lanes);
            kernel.kernelRows(uintRow{first, kernel.live});
        }
    } else {
        for (uint invocation = begin; invocation < end; ++invocation) kernel.kernelBody(invocation);
    }
}
#else
template <class Kernel>
SPHERULE_CLONES void run(const Binding& binding, uint begin, uint end) {
    Kernel kernel(binding);
    for (uint invocation = begin; invocation < end; ++invocation) kernel.kernelBody(invocation);
}
#endif

}  // namespace spherule::compute::cpu::SPHERULE_PRECISION

#define SPHERULE_ACCESS_readonly(type) const type*
#define SPHERULE_ACCESS_writeonly(type) type*
#define SPHERULE_ACCESS_restrict(type) type*
#define SPHERULE_ACCESS_coherent(type) type*

#define precise  // C++ compilers take no such liberties
#define PRIVATE(type, name) type name;
// With the builtin function, GCC would take a function that only prefetches for one without any effect.
#if defined(__x86_64__)
#define PREFETCH(element) asm volatile("prefetcht0 %0" : : "m"(element));
#else
#define PREFETCH(element) __builtin_prefetch(&(element));
#endif
#define HAS(feature) ((binding.features & (feature)) != 0U)
#define BUFFER(access, type, name) SPHERULE_ACCESS_##access(type) name = slot<type>(placeAmong(declared, #name));
#define PARAMETERS const Parameters params = copyOfParameters<Parameters>();
#define KERNEL(count)                  \
    [[nodiscard]] uint kernelCount() { \
        return count;                  \
    }                                  \
    void kernelBody([[maybe_unused]] uint invocation)

#define SEEN(word) wordOf(word)
#define NO_LOOP_LIMIT 0xffffffffU
#define LOOP_LIMIT NO_LOOP_LIMIT
#define RARE __attribute__((noinline, flatten))
#define THREAD firstThread
#define THREADS 1U
#define FIRST_THREAD true
#define SHARED(type, name) type name;
#define BARRIER
#define BUFFER_BARRIER
#define BUNDLE_KERNEL(count) KERNEL(count)
// Visits the pairs of a bundle, `step` of one batch at a time.
#define SPHERULE_PAIR_KERNEL(step, visit)                                                 \
    [[nodiscard]] uint kernelCount() {                                                    \
        return bundlesOfPhase();                                                          \
    }                                                                                     \
    void kernelBody(uint index) {                                                         \
        const uint bundle = bundleOfPhase(index);                                         \
        if (!beginBundle(bundle)) return;                                                 \
        uint from = firstPair(bundle);                                                    \
        for (uint batch = 0; batch < BATCHES; ++batch) {                                  \
            const uint to = endOfBatch(bundle, batch);                                    \
            for (uint k = from; k < to; k += (step)) visit(bundle, k, min(to - k, step)); \
            from = to;                                                                    \
        }                                                                                 \
        for (uint k = from; k < endOfPairs(bundle); ++k) visit(bundle, k, 1);             \
        endBundle(bundle);                                                                \
    }
#define SPHERULE_VISIT_ONE(bundle, k, count) visitPairs(pairs[k].x, pairs[k].y, k)
#define PAIR_KERNEL SPHERULE_PAIR_KERNEL(1U, SPHERULE_VISIT_ONE)

#if defined(SPHERULE_LANES)
#define ANY_REAL auto
#define ANY_REAL3 auto
#define ANY_REAL4 auto
#define ANY_MASK auto
#define ANY_UINT auto
#define ROW(array, at) rowsOf(array, at)
#define SET_ROW(where, array, at, to, old) setRows(where, array, at, to, old, live);
#define SET_ALL(array, at, to) setAll(array, at, to);
#define MEMBER(array, at, member) membersOf(array, at, &std::remove_cvref_t<decltype(*(array))>::member)
#define EACH_LANE(where, function, at) callForLanes(where, at, [this](uint lane) { function(lane); });
#define EACH_LANE_WITH(where, flag, function, at) \
    callForLanes(where, flag, at, [this](uint number, bool flagged) { function(number, flagged); });
#define EACH_LANE_VECTORS(where, function, number, more, a, b) \
    callForLanes(where, number, a, b, [&](uint ofLane, const vec3& x, const vec3& y) { function(ofLane, more, x, y); });
#define EACH_LANE_NUMBER(where, function, more) callForLanes(where, [&](uint lane) { function(lane, more); });
#define REMEMBERS(pairs, b, at) highestBits(pairs, at)
#define SLOTS_OF(b) (b)
#define LANE_OF(value, lane) laneOf(value, lane)
#define ROWS_UP_TO(first, end)             \
    uintRow {                              \
        first, min((end) - (first), lanes) \
    }
#define IN_ROWS(at) firstLanes((at).live)
#define LANES lanes
#define SUM_OF_LANES(value) sumOf(value)
#define LANE_BUNDLE_KERNEL(count) KERNEL(count)
#define RAISE_TO(where, word, value)                                                               \
    if (const mask raising = (where) && (value) > uintBitsToFloat(wordOf(word)); anyLane(raising)) \
        atomicMax(word, floatBitsToUint(largestOf(raising, value)));
#define LANE_KERNEL(count)             \
    [[nodiscard]] uint kernelCount() { \
        return count;                  \
    }                                  \
    void kernelRows(uintRow invocation)
#define SPHERULE_VISIT_LANES(bundle, k, count) visitLanes(bundle, k, count)
#define LANE_PAIR_KERNEL                                                        \
    RowOffsets firstOffsets;                                                    \
    RowOffsets secondOffsets;                                                   \
    void expectLanes(uint first, uint end) {                                    \
        if (first < end) expectPairs(first, min(end - first, lanes));           \
    }                                                                           \
    void visitLanes(uint bundle, uint first, uint count) {                      \
        if (expectsPairs()) expectLanes(first + 2 * lanes, endOfPairs(bundle)); \
        live = count;                                                           \
        readPairs(pairs + first, firstOffsets, secondOffsets);                  \
        visitPairs({&firstOffsets}, {&secondOffsets}, {first, count});          \
    }                                                                           \
    SPHERULE_PAIR_KERNEL(lanes, SPHERULE_VISIT_LANES)
#else
#define ANY_REAL real
#define ANY_REAL3 real3
#define ANY_REAL4 real4
#define ANY_MASK bool
#define ANY_UINT uint
#define ROW(array, at) (array)[at]
#define SET_ROW(where, array, at, to, old) \
    if (where) (array)[at] = to;
#define SET_ALL(array, at, to) (array)[at] = to;
#define MEMBER(array, at, member) (array)[at].member
#define EACH_LANE(where, function, at) \
    if (where) function(at);
#define EACH_LANE_WITH(where, flag, function, at) \
    if (where) function(at, flag);
#define EACH_LANE_VECTORS(where, function, number, more, a, b) \
    if (where) function(number, more, a, b);
#define EACH_LANE_NUMBER(where, function, more) \
    if (where) function(0, more);
#define REMEMBERS(pairs, b, at) (((b)&PAIR_REMEMBERS) != 0)
#define SLOTS_OF(b) ((b) & ~PAIR_REMEMBERS)
#define LANE_OF(value, lane) (value)
#define ROWS_UP_TO(first, end) (first)
#define IN_ROWS(at) true
#define LANES 1U
#define SUM_OF_LANES(value) (value)
#define LANE_BUNDLE_KERNEL(count) KERNEL(count)
#define RAISE_TO(where, word, value) \
    if (where) atomicMax(word, floatBitsToUint(value));
#define LANE_KERNEL(count) KERNEL(count)
#define LANE_PAIR_KERNEL PAIR_KERNEL
#endif
