// Compiles a .comp file as C++: the file is included in the body of a struct. The counterpart of
// shaders/shared/kernel.h. Buffers are members that point into the slots of a launch. So there are no globals, and
// several simulations can run at once. Only one thread at a time may use an object, because PRIVATE variables are
// members too.
//
// Included once by each translation unit that compiles the kernels. The unit first defines:
//   SPHERULE_REAL        the type for `float` in kernels: float or double
//   SPHERULE_PRECISION   the namespace of the kernels, which contains vec3 and vec4 of that type

// Kernels share callbacks whose parameters some kernels do not use, and Mesa refuses a parameter without a name.
#pragma GCC diagnostic ignored "-Wunused-parameter"

#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "compute/cpu/features.h"
#include "compute/cpu/kernels.h"

namespace spherule::compute::cpu::SPHERULE_PRECISION {

using real = SPHERULE_REAL;
using glm::uvec2;
using glm::uvec4;
using uint = std::uint32_t;

// GLSL's scalar functions. If an operand is NaN, they choose the same operand as GLSL.
inline real min(real a, real b) {
    return b < a ? b : a;
}
inline real max(real a, real b) {
    return a < b ? b : a;
}
inline uint min(uint a, uint b) {
    return b < a ? b : a;
}
inline uint max(uint a, uint b) {
    return a < b ? b : a;
}
inline real clamp(real x, real low, real high) {
    return min(max(x, low), high);
}
inline real abs(real x) {
    return std::fabs(x);
}
inline real floor(real x) {
    return std::floor(x);
}
inline real sqrt(real x) {
    return std::sqrt(x);
}
inline real uintBitsToFloat(uint x) {
    return static_cast<real>(std::bit_cast<float>(x));
}
inline uint floatBitsToUint(real x) {
    return std::bit_cast<uint>(static_cast<float>(x));
}
// Return the index of the highest and of the lowest set bit; -1 if no bit is set.
inline int findMSB(uint x) {
    return 31 - std::countl_zero(x);
}
inline int findLSB(uint x) {
    return x == 0 ? -1 : std::countr_zero(x);
}

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

    Binding binding;
    uint phase;
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

template <class Kernel>
SPHERULE_CLONES void run(const Binding& binding, uint begin, uint end) {
    Kernel kernel(binding);
    for (uint invocation = begin; invocation < end; ++invocation) kernel.kernelBody(invocation);
}

}  // namespace spherule::compute::cpu::SPHERULE_PRECISION

#define SPHERULE_ACCESS_readonly(type) const type*
#define SPHERULE_ACCESS_writeonly(type) type*
#define SPHERULE_ACCESS_restrict(type) type*
#define SPHERULE_ACCESS_coherent(type) type*

#define precise  // C++ compilers take no such liberties
#define PRIVATE(type, name) type name;
#define PREFETCH(element) __builtin_prefetch(&(element));
#define HAS(feature) ((binding.features & (feature)) != 0U)
#define BUFFER(access, type, name) SPHERULE_ACCESS_##access(type) name = slot<type>(placeAmong(declared, #name));
#define PARAMETERS const Parameters params = copyOfParameters<Parameters>();
#define KERNEL(count)                  \
    [[nodiscard]] uint kernelCount() { \
        return count;                  \
    }                                  \
    void kernelBody([[maybe_unused]] uint invocation)
