#pragma once

#include <glm/vec3.hpp>

// The reference for the kernels of the model `accurate`: one contact in double, in tiny steps. It is written after
// docs/accuracy.md, but integrates the force of the tangential spring instead of its elongation.
namespace spherule::reference {

struct SoftBody {
    glm::dvec3 x{};          // m
    glm::dvec3 v{};          // m/s
    glm::dvec3 spin{};       // rad/s
    double radius = 0;       // m
    double inverseMass = 0;  // 1/kg

    [[nodiscard]] double rotationalEnergy() const;  // J, of a solid sphere
};

struct SoftLaw {
    bool hertz = false;
    double normal = 0;      // Pa, effective modulus
    double tangential = 0;  // Pa, effective shear modulus
    double damping = 0;     // damping ratio
    double friction = 0;
};

// Lets two approaching spheres collide and separate. `steps`: number of steps in the contact time without damping.
void meet(SoftBody& a, SoftBody& b, const SoftLaw& law, int steps = 20000);

// Same as meet(), with the half-space z < 0 instead of a second sphere.
void meetFloor(SoftBody& body, const SoftLaw& law, int steps = 20000);

}  // namespace spherule::reference
