#pragma once

#include <array>
#include <functional>

#include <glm/vec3.hpp>

#include "scene/random.h"
#include "support.h"

// Single spheres in fields, and a reference in double precision that shares no code with the program.
namespace spherule::physics {

constexpr double fieldRadius = 0.05;                  // m
constexpr double fieldVolume = 5.235987755982989e-4;  // m^3
constexpr double fieldMass = 1000 * fieldVolume;      // kg
inline constexpr std::array fieldModels = {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate};

glm::dvec3 randomDirection(scene::Random& random);

// One sphere of 5 cm and 1000 kg/m^3 in open space, with steps of one substep of 1/480 s.
scene::Scene oneSphere(scene::Model model, glm::dvec3 place, glm::dvec3 velocity);

// The place of a sphere (m), in the coordinates of the scene.
glm::dvec3 placeOf(sim::Simulation& simulation, std::uint32_t id = 0);
glm::dvec3 speedOf(sim::Simulation& simulation, std::uint32_t id = 0);

// The laws of the fields (N) for a sphere of `fieldRadius`.
glm::dvec3 dragForce(const scene::Drag& drag, const glm::dvec3& x, const glm::dvec3& v);
glm::dvec3 buoyancyForce(const scene::Buoyancy& liquid, const glm::dvec3& gravity, const glm::dvec3& x);
glm::dvec3 windAt(const scene::Drag& drag, const glm::dvec3& x);  // m/s

// The acceleration (m/s^2) of the sphere by gravity and all fields. Regions do not count.
glm::dvec3 accelerationOf(const scene::Forces& forces, const glm::dvec3& x, const glm::dvec3& v);

struct Motion {
    glm::dvec3 x;
    glm::dvec3 v;
};

// The classical Runge-Kutta method of fourth order, with steps of 50 us.
Motion integrated(const scene::Forces& forces, Motion from, double seconds);

// The depth of the centre (m) at which the submerged part of the sphere has this share of its volume.
double depthWithShare(double share);

// Kinetic plus potential energy (J).
double energyOf(sim::Simulation& simulation);

}  // namespace spherule::physics
