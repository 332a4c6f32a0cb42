#pragma once

// Kernels share callbacks whose parameters not every kernel needs, and Mesa refuses a parameter without a name.
#pragma GCC diagnostic ignored "-Wunused-parameter"

#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>

// What turns a .comp file, included in the body of a struct, into C++: the counterpart of shaders/shared/kernel.h.
// Buffers are members that point into the slots of a launch, so that there are no globals and several worlds can run at
// once; an object serves one thread at a time, because PRIVATE variables are members too.
namespace spherule::kernels {

using glm::uvec2;
using glm::uvec4;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;

// GLSL's scalar functions, with GLSL's choice of operand where one is NaN.
inline float min(float a, float b) {
    return b < a ? b : a;
}
inline float max(float a, float b) {
    return a < b ? b : a;
}
inline uint min(uint a, uint b) {
    return b < a ? b : a;
}
inline uint max(uint a, uint b) {
    return a < b ? b : a;
}
inline float clamp(float x, float low, float high) {
    return min(max(x, low), high);
}
inline float abs(float x) {
    return std::fabs(x);
}
inline float floor(float x) {
    return std::floor(x);
}
inline float sqrt(float x) {
    return std::sqrt(x);
}
inline uint floatBitsToUint(float x) {
    return std::bit_cast<uint>(x);
}

inline uint atomicAdd(uint& memory, uint value) {
    return std::atomic_ref<uint>(memory).fetch_add(value, std::memory_order_relaxed);
}

inline uint atomicOr(uint& memory, uint value) {
    return std::atomic_ref<uint>(memory).fetch_or(value, std::memory_order_relaxed);
}

inline uint atomicMax(uint& memory, uint value) {
    const std::atomic_ref<uint> word(memory);
    uint seen = word.load(std::memory_order_relaxed);
    while (seen < value && !word.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
    }
    return seen;
}

// One launch. A slot that the scene's features leave unused may be null.
struct Binding {
    std::span<void* const> slots;
    const void* parameters = nullptr;  // as `Parameters` of shaders/shared/layout.h; null for kernels without them
    uint phase = 0;
    uint features = 0;  // bits of `KernelBase`
};

// What the struct around a .comp file derives from.
struct KernelBase {
    enum Feature : uint {
        GRAVITY = 1U << 0U,
        CONTACTS = 1U << 1U,
        RADII = 1U << 2U,
        RESTITUTION = 1U << 3U,
        RESTITUTIONS = 1U << 4U,
        BEFORE = 1U << 5U,
        WALLS = 1U << 6U,
        PLANES = 1U << 7U,
        BOXES = 1U << 8U,
        SLEEP = 1U << 9U,
    };

    explicit KernelBase(const Binding& bound) : binding(bound), phase(bound.phase) {}

    template <class T>
    [[nodiscard]] T* slot(std::size_t number) const {
        return number < binding.slots.size() ? static_cast<T*>(binding.slots[number]) : nullptr;
    }

    // A copy: compilers then know that no buffer overlaps it.
    template <class T>
    [[nodiscard]] T copyOfParameters() const {
        T copy{};
        if (binding.parameters != nullptr) std::memcpy(&copy, binding.parameters, sizeof copy);
        return copy;
    }

    Binding binding;
    uint phase;
};

// Runs every invocation of `Kernel`, one after another.
template <class Kernel>
void run(const Binding& binding) {
    Kernel kernel(binding);
    const uint count = kernel.kernelCount();
    for (uint invocation = 0; invocation < count; ++invocation) kernel.kernelBody(invocation);
}

}  // namespace spherule::kernels

#define SPHERULE_ACCESS_readonly(type) const type*
#define SPHERULE_ACCESS_writeonly(type) type*
#define SPHERULE_ACCESS_restrict(type) type*
#define SPHERULE_ACCESS_coherent(type) type*

#define PRIVATE(type, name) type name;
#define HAS(feature) ((binding.features & (feature)) != 0U)
#define BUFFER(number, access, type, name, block) SPHERULE_ACCESS_##access(type) name = slot<type>(number);
#define PARAMETERS const Parameters params = copyOfParameters<Parameters>();
#define KERNEL(count)                        \
    [[nodiscard]] uint kernelCount() const { \
        return count;                        \
    }                                        \
    void kernelBody([[maybe_unused]] uint invocation)
