#pragma once

#include <algorithm>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "core/result.h"
#include "scene/fields.h"

namespace spherule::scene {

struct Scene;
struct Sphere;

// The forces on every sphere besides contacts.
struct Forces {
    glm::dvec3 gravity{};  // m/s^2
    std::vector<Field> fields;

    // Returns the acceleration (m/s^2) of a sphere at rest at `place` (m), without drag.
    [[nodiscard]] glm::dvec3 accelerationAt(const glm::dvec3& place, const Body& body) const;
    // Returns the acceleration (m/s^2) by drag of a sphere at `place` (m) with a velocity (m/s).
    [[nodiscard]] glm::dvec3 dragAt(const glm::dvec3& place, const glm::dvec3& velocity, const Body& body) const;
    // Returns the potential of the fields (J/kg), without gravity, where a sphere begins, or a higher value where it
    // may enter their regions. It is 0 far away from all centres of attraction, at the centres of springs, and above
    // liquids. A liquid without a surface has 0 at `top`. Drag has none: it is not conservative.
    [[nodiscard]] double highestFieldPotential(const glm::dvec3& place, const Body& body, const glm::dvec3& top) const;
    // Returns the lowest potential of the fields (J/kg) that spheres can reach. nearestTo(centre): how near to a centre
    // they can come (m).
    template <class Function>
    [[nodiscard]] double lowestFieldPotential(const Function& nearestTo) const;
    // Returns the largest angular frequency (rad/s) of a sphere that swings in springs and liquids; 0 without these.
    [[nodiscard]] double frequencyOf(const Body& body) const;
    // Returns true if fields add energy to spheres that statistics do not show.
    [[nodiscard]] bool addEnergy() const;
};

Body bodyOf(const Scene& scene, const Sphere& sphere);

// Returns the corner of the bounds (m) that is highest against gravity.
glm::dvec3 topOf(const Scene& scene);

// Returns the largest acceleration (m/s^2) by gravity and fields at the places where spheres begin, of spheres at rest,
// and by obstacles that carry spheres. It is at least gravity alone. In large scenes, 5,000 to 10,000 spheres are
// asked.
double strongestAcceleration(const Scene& scene);

// Returns the largest angular frequency (rad/s) at which springs and liquids swing a sphere of the scene; 0 if none
// does.
double highestFieldFrequency(const Scene& scene);

// Refuses gravity with which the liquids of a scene cannot rest: none, or along a periodic axis.
Result<void> checkLiquids(const Scene& scene);

double potentialOf(const Attraction& attraction, double distance);

template <class Function>
double Forces::lowestFieldPotential(const Function& nearestTo) const {
    double sum = 0;
    for (const Field& field : fields)
        if (const auto* const attraction = std::get_if<Attraction>(&field))
            sum += std::min(potentialOf(*attraction, nearestTo(attraction->centre)), 0.0);
    return sum;
}

}  // namespace spherule::scene
