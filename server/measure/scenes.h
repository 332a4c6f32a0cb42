#pragma once

#include <glm/vec3.hpp>

#include "scene/scene.h"
#include "sim/state.h"

// Scenes of the cases, around the origin, so a state has the same coordinates as its scene. Also functions that read a
// state.
namespace spherule::measure {

constexpr double earth = 9.81;  // m/s^2

// A cube of `side` m with open faces, without gravity or sleep, in steps of 1/60 s.
scene::Scene openSpace(double side);

// Same as openSpace(), with closed faces and the earth's gravity.
scene::Scene closedBox(double side);

void setRestitution(scene::Scene& scene, double restitution);  // of all materials
void setFriction(scene::Scene& scene, double friction);

// Adds a material; returns its index.
std::uint8_t addMaterial(scene::Scene& scene, const scene::Material& material);
scene::Sphere& addSphere(scene::Scene& scene, glm::dvec3 position, double radius, glm::dvec3 velocity = {},
                         std::uint8_t material = 0);

// A lattice of `count` spheres with gaps of a tenth of a diameter, each moved a little. It stands on the floor of a box
// that is `across` diameters wide and deep, and open above.
scene::Scene lattice(std::uint32_t count, double radius, double across);

}  // namespace spherule::measure
