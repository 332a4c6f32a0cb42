// A float that errs as on a GPU, and vectors of it. An error depends on the operands, on the operation, on the kernel
// and on the seed, so the same operation in one kernel always gives the same bits.
//
//   division, square root   up to 2 ulp
//   product                 up to 1 ulp, only if it is rounded: as if it was contracted with an addition. Products are
//                           commutative. `precise` forbids this on a GPU, but not here.
//   every result            0 in the place of a denormal number
//
// Errors do not depend on signs: a (-b) is -(a b), as on a GPU. The two sides of an edge depend on it
// (mesh_surfaces.h).
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

namespace spherule::instruments {

struct Perturbation {
    std::uint32_t seed = 0;       // 0: no errors
    std::uint32_t divisions = 2;  // largest error of divisions and square roots (ulp)
    std::uint32_t products = 1;   // largest error of products (ulp)
    std::uint32_t salt = 0;       // by seed and kernel
};
inline thread_local Perturbation perturbation;  // of the launch at work on this thread

constexpr std::uint32_t saltOf(std::string_view kernel, std::uint32_t seed) {
    std::uint32_t hash = seed * 0x9e3779b1U;
    for (const char letter : kernel) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x01000193U;
    return hash;
}

}  // namespace spherule::instruments

namespace spherule::compute::cpu::SPHERULE_PRECISION {

enum class Operation : std::uint32_t { Product = 1, Division = 2, Root = 3 };

inline float withoutDenormals(float x) {
    return std::fabs(x) < std::numeric_limits<float>::min() ? std::copysign(0.0F, x) : x;
}

// Moves a number by -most .. most ulp, all with the same probability. Zero, infinite and NaN stay. Inlined, it would
// make the kernels very large.
[[gnu::noinline]] inline float moved(float exact, float a, float b, Operation operation, std::uint32_t most) {
    if (instruments::perturbation.seed == 0 || most == 0) return withoutDenormals(exact);
    std::uint32_t hash = std::bit_cast<std::uint32_t>(a) * 0x9e3779b1U;
    hash ^= (std::bit_cast<std::uint32_t>(b) + 0x7f4a7c15U) * 0x85ebca6bU;
    hash ^= static_cast<std::uint32_t>(operation) * 0xc2b2ae35U ^ instruments::perturbation.salt;
    hash ^= hash >> 15U;
    hash *= 0x2c1b3c6dU;
    hash ^= hash >> 12U;
    hash *= 0x297a2d39U;
    hash ^= hash >> 15U;
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(exact) + hash % (2 * most + 1) - most;
    const auto normal = [](float x) { return std::isnormal(x); };
    const auto result = std::bit_cast<float>(bits);
    return withoutDenormals(normal(exact) && normal(result) ? result : exact);
}

class Perturbed {
  public:
    Perturbed() = default;
    constexpr Perturbed(float x) : value_(x) {}
    constexpr Perturbed(double x) : value_(static_cast<float>(x)) {}
    constexpr Perturbed(int x) : value_(static_cast<float>(x)) {}
    constexpr Perturbed(std::uint32_t x) : value_(static_cast<float>(x)) {}

    explicit constexpr operator float() const { return value_; }
    explicit operator int() const { return static_cast<int>(value_); }
    explicit operator std::uint32_t() const { return static_cast<std::uint32_t>(value_); }

    Perturbed operator-() const { return -value_; }
    friend Perturbed operator+(Perturbed a, Perturbed b) { return withoutDenormals(a.value_ + b.value_); }
    friend Perturbed operator-(Perturbed a, Perturbed b) { return withoutDenormals(a.value_ - b.value_); }
    friend Perturbed operator*(Perturbed a, Perturbed b) {
        const float rounded = a.value_ * b.value_;
        // Exact in double precision.
        if (static_cast<double>(a.value_) * static_cast<double>(b.value_) == static_cast<double>(rounded))
            return withoutDenormals(rounded);
        const float first = std::fabs(a.value_);
        const float second = std::fabs(b.value_);
        return moved(rounded, std::min(first, second), std::max(first, second), Operation::Product,
                     instruments::perturbation.products);
    }
    friend Perturbed operator/(Perturbed a, Perturbed b) {
        return moved(a.value_ / b.value_, std::fabs(a.value_), std::fabs(b.value_), Operation::Division,
                     instruments::perturbation.divisions);
    }
    friend Perturbed sqrt(Perturbed a) {
        return moved(std::sqrt(a.value_), a.value_, 0, Operation::Root, instruments::perturbation.divisions);
    }
    friend Perturbed abs(Perturbed a) { return std::fabs(a.value_); }
    friend Perturbed floor(Perturbed a) { return std::floor(a.value_); }
    Perturbed& operator+=(Perturbed b) { return *this = *this + b; }

    friend bool operator==(Perturbed a, Perturbed b) { return a.value_ == b.value_; }
    friend auto operator<=>(Perturbed a, Perturbed b) { return a.value_ <=> b.value_; }

  private:
    float value_;
};

struct alignas(16) vec4 {
    Perturbed x, y, z, w;

    vec4() = default;
    vec4(Perturbed first, Perturbed second, Perturbed third, Perturbed fourth)
        : x(first), y(second), z(third), w(fourth) {}
    inline vec4(const struct vec3& xyz, Perturbed fourth);
};

struct alignas(16) vec3 {
    Perturbed x, y, z;

    vec3() = default;
    explicit vec3(const vec4& xyz) : x(xyz.x), y(xyz.y), z(xyz.z) {}
    vec3(Perturbed first, Perturbed second, Perturbed third) : x(first), y(second), z(third) {}
};

inline vec4::vec4(const vec3& xyz, Perturbed fourth) : x(xyz.x), y(xyz.y), z(xyz.z), w(fourth) {}

inline vec3 operator+(const vec3& a, const vec3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline vec3 operator-(const vec3& a, const vec3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline vec3 operator-(const vec3& a) {
    return {-a.x, -a.y, -a.z};
}
inline vec3 operator*(const vec3& a, const vec3& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
inline vec3 operator*(const vec3& a, Perturbed factor) {
    return {a.x * factor, a.y * factor, a.z * factor};
}
inline vec4 operator+(const vec4& a, const vec4& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}

// Literals are float, and would otherwise be taken for uint.
inline Perturbed min(float a, float b) {
    return std::min(a, b);
}
inline Perturbed max(float a, float b) {
    return std::max(a, b);
}
inline Perturbed select(bool where, float yes, float no) {
    return where ? yes : no;
}

}  // namespace spherule::compute::cpu::SPHERULE_PRECISION
