#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include <spdlog/fmt/fmt.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace spherule::scene {

struct Scene;

// Drag in a medium at rest: F = -1/2 density coefficient pi r^2 |v| v.
struct Drag {
    double density = 1.2;       // of the medium, kg/m^3
    double coefficient = 0.47;  // of a smooth sphere
};

// Attraction to a point: the acceleration is strength d / (|d|^2 + softening^2)^(3/2), where d points to the centre.
struct Attraction {
    glm::dvec3 centre{};   // m
    double strength = 0;   // m^3/s^2; negative: repels
    double softening = 0;  // m, above 0
};

// The kinds in the order of shaders/shared/fields.h.
using Field = std::variant<Drag, Attraction>;

constexpr unsigned maxFields = 8;

// The forces on every sphere besides contacts. This file is the only one that reads them from a scene.
struct Forces {
    glm::dvec3 gravity{};  // m/s^2
    std::vector<Field> fields;

    // Reads the forces of a v1::Scene. A template, so that users of a Scene need neither messages nor Check.
    template <class Check, class Message>
    static Forces read(Check& check, const Message& message);

    // Returns the acceleration (m/s^2) of a sphere at rest at `place` (m).
    [[nodiscard]] glm::dvec3 accelerationAt(const glm::dvec3& place) const;
    // Returns the potential of the fields (J/kg) at `place`, without gravity. It is 0 far away from all centres.
    // Drag has none: it is not conservative.
    [[nodiscard]] double fieldPotentialAt(const glm::dvec3& place) const;
    // Returns the lowest potential of the fields (J/kg) that spheres can reach. nearestTo(centre): how near to a centre
    // they can come (m).
    template <class Function>
    [[nodiscard]] double lowestFieldPotential(const Function& nearestTo) const;
};

// Returns the largest acceleration (m/s^2) by gravity and fields at the places where spheres begin, and by obstacles
// that carry spheres. It is at least gravity alone. In large scenes, 5,000 to 10,000 spheres are asked.
double strongestAcceleration(const Scene& scene);

inline double potentialOf(const Attraction& attraction, double distance) {
    return -attraction.strength / std::hypot(distance, attraction.softening);
}

inline glm::dvec3 Forces::accelerationAt(const glm::dvec3& place) const {
    glm::dvec3 sum = gravity;
    for (const Field& field : fields) {
        const auto* const attraction = std::get_if<Attraction>(&field);
        if (attraction == nullptr) continue;
        const glm::dvec3 d = attraction->centre - place;
        sum += d * (attraction->strength / std::pow(std::hypot(glm::length(d), attraction->softening), 3));
    }
    return sum;
}

inline double Forces::fieldPotentialAt(const glm::dvec3& place) const {
    double sum = 0;
    for (const Field& field : fields)
        if (const auto* const attraction = std::get_if<Attraction>(&field))
            sum += potentialOf(*attraction, glm::distance(attraction->centre, place));
    return sum;
}

template <class Function>
double Forces::lowestFieldPotential(const Function& nearestTo) const {
    double sum = 0;
    for (const Field& field : fields)
        if (const auto* const attraction = std::get_if<Attraction>(&field))
            sum += std::min(potentialOf(*attraction, nearestTo(attraction->centre)), 0.0);
    return sum;
}

template <class Check, class Message>
Forces Forces::read(Check& check, const Message& message) {
    constexpr double densest = 1e5;     // kg/m^3
    constexpr double roughest = 1e3;    // coefficient
    constexpr double strongest = 1e9;   // m^3/s^2
    constexpr double narrowest = 1e-6;  // m, so that its cube is a normal float
    constexpr double widest = 1e9;      // m
    constexpr double steepest = 1e6;    // m/s^2
    Forces forces;
    forces.gravity = check.vectorOr(message.gravity(), {0, 0, -9.81}, "gravity");
    if (static_cast<unsigned>(message.fields_size()) > maxFields)
        check.refuse("fields", fmt::format("has {} entries, must have at most {}", message.fields_size(), maxFields));
    for (int k = 0; k < message.fields_size() && check.ok(); ++k) {
        const auto& field = message.fields(k);
        const std::string at = fmt::format("fields[{}]", k);
        if (field.has_drag()) {
            Drag drag;
            if (field.drag().has_density())
                drag.density = check.within(field.drag().density(), 0, densest, at + ".drag.density", " kg/m^3");
            if (field.drag().has_coefficient())
                drag.coefficient = check.within(field.drag().coefficient(), 0, roughest, at + ".drag.coefficient");
            forces.fields.emplace_back(drag);
        } else if (field.has_attraction()) {
            const auto& from = field.attraction();
            const Attraction attraction{
                .centre = check.vector(from.centre(), at + ".attraction.centre"),
                .strength =
                    check.within(from.strength(), -strongest, strongest, at + ".attraction.strength", " m^3/s^2"),
                .softening = check.within(from.softening(), narrowest, widest, at + ".attraction.softening", " m")};
            // The acceleration is largest at softening / sqrt(2).
            const double largest = std::abs(attraction.strength) * 2 / (3 * std::numbers::sqrt3) /
                                   (attraction.softening * attraction.softening);
            if (largest > steepest)
                check.refuse(at + ".attraction",
                             fmt::format("accelerates spheres near its centre by up to {:.3g} m/s^2, at most {:g} is "
                                         "allowed; use a larger softening or a smaller strength",
                                         largest, steepest));
            forces.fields.emplace_back(attraction);
        } else {
            check.refuse(at, "has no kind, must be drag or attraction");
        }
    }
    return forces;
}

}  // namespace spherule::scene
