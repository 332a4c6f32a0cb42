#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scene/scene.h"

namespace spherule::sim {

// What the device holds of the spheres, in id order.
struct State {
    std::vector<glm::vec4> position;  // m, relative to the bounds' centre; w = radius
    std::vector<glm::vec4> velocity;  // m/s; w = 1 / mass, negative while asleep
    std::vector<glm::vec4> spin;      // angular velocity, rad/s; w = 0

    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(position.size()); }
};

State stateOf(const scene::Scene& scene);
// Of these spheres, of the scene's materials, in its bounds.
State stateOf(const scene::Scene& scene, std::span<const scene::Sphere> spheres);
// By id.
std::vector<std::uint8_t> materialsOf(const scene::Scene& scene);

// Figures of a state, in double and SI units; places relative to the bounds' centre.
glm::dvec3 positionOf(const State& state, std::uint32_t id);
glm::dvec3 velocityOf(const State& state, std::uint32_t id);
glm::dvec3 spinOf(const State& state, std::uint32_t id);
double massOf(const State& state, std::uint32_t id);
double radiusOf(const State& state, std::uint32_t id);
glm::dvec3 momentumOf(const State& state);
double momentumScale(const State& state);    // sum of m |v|
double kineticEnergyOf(const State& state);  // of translation and rotation

// Of ids, positions, velocities and spins, bit by bit (XXH3).
std::uint64_t hashOf(const State& state);

}  // namespace spherule::sim
