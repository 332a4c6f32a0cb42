// vec3 and vec4 of the float kernels, each in one register, with the part of GLM's interface that the kernels use. From
// GLM's separate floats, GCC generates three to four times as many loads, sums and stores.
//
// The fourth lane of a vec3 is undefined: a vec3 made from a vec4 keeps the vec4's fourth lane.
#pragma once

namespace spherule::compute::cpu::SPHERULE_PRECISION {

using Lanes = float __attribute__((vector_size(16)));

struct vec4 {
    union {
        Lanes lanes;
        __extension__ struct { float x, y, z, w; };
    };

    vec4() = default;
    vec4(const vec4& other) : lanes(other.lanes) {}
    vec4& operator=(const vec4& other) {
        lanes = other.lanes;
        return *this;
    }
    explicit vec4(Lanes value) : lanes(value) {}
    vec4(float first, float second, float third, float fourth) : lanes{first, second, third, fourth} {}
    inline vec4(const struct vec3& xyz, float fourth);
};

struct vec3 {
    union {
        Lanes lanes;
        __extension__ struct { float x, y, z; };
    };

    vec3() = default;
    vec3(const vec3& other) : lanes(other.lanes) {}
    vec3& operator=(const vec3& other) {
        lanes = other.lanes;
        return *this;
    }
    explicit vec3(Lanes value) : lanes(value) {}
    explicit vec3(const vec4& xyz) : lanes(xyz.lanes) {}
    vec3(float first, float second, float third) : lanes{first, second, third, 0} {}
};

inline vec4::vec4(const vec3& xyz, float fourth) : lanes{xyz.lanes[0], xyz.lanes[1], xyz.lanes[2], fourth} {}

inline vec3 operator+(const vec3& a, const vec3& b) {
    return vec3(a.lanes + b.lanes);
}
inline vec3 operator-(const vec3& a, const vec3& b) {
    return vec3(a.lanes - b.lanes);
}
inline vec3 operator-(const vec3& a) {
    return vec3(-a.lanes);
}
inline vec3 operator*(const vec3& a, const vec3& b) {
    return vec3(a.lanes * b.lanes);
}
inline vec3 operator*(const vec3& a, float factor) {
    return vec3(a.lanes * factor);
}
inline vec4 operator+(const vec4& a, const vec4& b) {
    return vec4(a.lanes + b.lanes);
}

}  // namespace spherule::compute::cpu::SPHERULE_PRECISION
