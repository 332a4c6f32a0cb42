#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scene/scene.h"
#include "sim/sphere_columns.h"

namespace spherule::sim {

// The state of the spheres, in id order.
struct State : SphereColumns {
    std::vector<std::uint64_t> ids{};  // ascending; empty: 0, 1, ...
    // With periodic axes, else empty: the lengths of each axis by which positions were moved back into the bounds.
    std::vector<glm::ivec3> images;

    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(position.size()); }
    [[nodiscard]] std::uint64_t idAt(std::uint32_t rank) const { return ids.empty() ? rank : ids[rank]; }
    // Adds the spheres of `more` behind the present ones. Does not change `ids`.
    void append(const State& more);
};

State stateOf(const scene::Scene& scene);
// Returns the state of `spheres`, which use the scene's materials and bounds.
State stateOf(const scene::Scene& scene, std::span<const scene::Sphere> spheres);
// Returns the materials by id of the sphere.
std::vector<std::uint8_t> materialsOf(const scene::Scene& scene);

// Values of a state as double, in SI units. Positions are relative to the bounds' centre. `id`: the place in the order
// of ids, which is the id itself as long as no sphere has been removed.
glm::dvec3 positionOf(const State& state, std::uint32_t id);
// Returns the position that the sphere would have without wrapping. `periods`: as Bounds::periods() returns them.
glm::dvec3 unwrappedOf(const State& state, std::uint32_t id, const glm::dvec3& periods);
glm::dvec3 velocityOf(const State& state, std::uint32_t id);
glm::dvec3 spinOf(const State& state, std::uint32_t id);
bool isFixed(const State& state, std::uint32_t id);
// Returns the mass of a sphere by its volume and density (kg), whether it is fixed or not.
double massOf(const scene::Scene& scene, const scene::Sphere& sphere);
double massOf(const State& state, std::uint32_t id);  // infinite if fixed
// Returns 1 / mass (1/kg) as the device has it; 0 if the sphere is fixed.
float inverseMassOf(const scene::Scene& scene, const scene::Sphere& sphere);
double radiusOf(const State& state, std::uint32_t id);
// The sums are over the spheres that are not fixed.
glm::dvec3 momentumOf(const State& state);
double momentumScale(const State& state);    // sum of m |v|
double kineticEnergyOf(const State& state);  // of translation and rotation

// Returns a hash (XXH3) over the bits of ids, positions, velocities and spins.
std::uint64_t hashOf(const State& state);

}  // namespace spherule::sim
