#pragma once

#include <glm/vec3.hpp>

// One contact of the model `accurate`, in double and in tiny steps: what its kernels are compared with. Written from
// the description of the law (docs/accuracy.md), with the force of the tangential spring in place of its stretch.
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

// Lets two spheres that approach each other meet and part; `steps` to the time that the contact takes without damping.
void meet(SoftBody& a, SoftBody& b, const SoftLaw& law, int steps = 20000);

// The same with the half-space z < 0.
void meetFloor(SoftBody& body, const SoftLaw& law, int steps = 20000);

}  // namespace spherule::reference
