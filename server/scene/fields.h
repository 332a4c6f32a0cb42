#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <google/protobuf/repeated_field.h>
#include <glm/vec3.hpp>

#include "scene/region.h"

namespace spherule::v1 {
class Field;
class Scene;
}  // namespace spherule::v1

// The fields of a scene and their laws. Kernels have the same laws in shaders/shared/fields.h.
namespace spherule::scene {

class Check;

constexpr unsigned maxFields = 8;

// The data of a sphere on which fields depend.
struct Body {
    double radius = 0;  // m
    double mass = 0;    // kg
};

// Rankine's vortex: the speed around the axis is speed r / core at the distance r < core from it, and speed core / r
// outside.
struct Vortex {
    glm::dvec3 centre{};       // m: a point of the axis
    glm::dvec3 axis{0, 0, 1};  // of unit length
    double speed = 0;          // m/s, at the core; counter-clockwise for a viewer to whom the axis points
    double core = 1;           // m
};

// Quadratic drag in a medium with the velocity u: F = -1/2 density coefficient pi r^2 |v - u| (v - u).
struct Drag {
    double density = 1.2;            // of the medium, kg/m^3
    double coefficient = 0.47;       // of a smooth sphere
    glm::dvec3 velocity{};           // of the medium, m/s
    std::optional<Vortex> vortex{};  // added to the velocity
    std::optional<Region> region{};  // nullopt: everywhere

    [[nodiscard]] bool moves() const { return velocity != glm::dvec3(0) || vortex; }
    [[nodiscard]] glm::dvec3 velocityAt(const glm::dvec3& place) const;
};

// Attraction to a point: the acceleration is strength d / (|d|^2 + softening^2)^(3/2), where d points to the centre.
struct Attraction {
    glm::dvec3 centre{};   // m
    double strength = 0;   // m^3/s^2; negative: repels
    double softening = 0;  // m, above 0
    std::optional<Region> region{};
};

// Buoyancy in a liquid at rest: F = -density V gravity, with the volume V of the sphere below the surface. The surface
// is a plane across gravity.
struct Buoyancy {
    double density = 1000;                // of the liquid, kg/m^3
    std::optional<glm::dvec3> surface{};  // m: a point of it; nullopt: the liquid is everywhere
    std::optional<Region> region{};
};

// A spring to a point with its length 0: F = stiffness (centre - x) - damping v.
struct Spring {
    glm::dvec3 centre{};   // m
    double stiffness = 0;  // N/m
    double damping = 0;    // N s/m
    std::optional<Region> region{};
};

// The kinds in the order of shaders/shared/fields.h.
using Field = std::variant<Drag, Attraction, Buoyancy, Spring>;

const std::optional<Region>& regionOf(const Field& field);
// Returns true if the field adds energy to spheres that statistics do not show: its medium moves, or its potential ends
// at the border of a region.
bool addsEnergy(const Field& field);

// Returns the volume (m^3) of the part of a sphere below a plane. `depth`: of its centre (m), negative above the plane.
double submergedVolume(double radius, double depth);
// Returns the integral of submergedVolume() (m^4) from a sphere above the plane down to `depth`.
double submergedIntegral(double radius, double depth);

// Reads a field of a scene. `at`: its place in the message. Returns nullopt if it has no kind, which it refuses.
std::optional<Field> readField(Check& check, const v1::Field& message, const std::string& at);
// Reads `fields` of a scene.
std::vector<Field> readFields(Check& check, const v1::Scene& message);
// Adds fields to a message.
void writeFields(google::protobuf::RepeatedPtrField<v1::Field>& messages, const std::vector<Field>& fields);

}  // namespace spherule::scene
