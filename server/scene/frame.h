#pragma once

#include <string>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

namespace spherule::v1 {
class Rotation;
}

namespace spherule::scene {

class Check;

// Coordinates that are turned, then moved: x in the frame is turn * x + origin outside.
struct Frame {
    glm::dmat3 turn{1};   // orthogonal
    glm::dvec3 origin{};  // m

    [[nodiscard]] glm::dvec3 outside(const glm::dvec3& x) const { return turn * x + origin; }
    [[nodiscard]] glm::dvec3 inside(const glm::dvec3& x) const { return glm::transpose(turn) * (x - origin); }
    // Returns the frame of a frame that is given in these coordinates.
    [[nodiscard]] Frame operator*(const Frame& other) const { return {turn * other.turn, outside(other.origin)}; }
};

// A rotation as scenes give it: counter-clockwise for a viewer to whom the axis points.
struct Rotation {
    glm::dvec3 axis{0, 0, 1};  // of any length but zero
    double degrees = 0;        // -360 to 360

    static Rotation of(const glm::dquat& turn);
    [[nodiscard]] glm::dquat quaternion() const;
};
Rotation readRotation(Check& check, const v1::Rotation& message, const std::string& field);
void writeRotation(v1::Rotation& message, const Rotation& rotation);

}  // namespace spherule::scene
