#pragma once

#include <cstdint>
#include <optional>

#include "scene/scene.h"

// How stiff the contacts of the model `accurate` are, and how short its substeps must be.
namespace spherule::scene {

struct Stiffness {
    double normal = 0;      // Pa: effective modulus; of linear springs k = 2 normal R*
    double damping = 0;     // damping ratio
    double tangential = 0;  // Pa: Mindlin's effective shear modulus; of linear springs k_t = 2 tangential R*
};

// Whether contacts follow Hertz and Mindlin: some material has a Young's modulus. (Then all must.)
bool followsHertz(const Scene& scene);

// The effective modulus of all linear springs (Pa); 0 with Hertz's law, which uses the moduli of the materials. With
// pinned substeps it is as large as they allow: a contact of the smallest spheres then takes 70 of them. Otherwise the
// fastest impact reaches the wanted overlap (m* v^2 = k d^2), and the weight of all spheres reaches a fifth of
// it.
double springModulus(const Scene& scene);

Stiffness stiffnessBetween(const Scene& scene, std::uint8_t a, std::uint8_t b, double springModulus);

// The damping ratio of a dashpot that gives `restitution`, for contacts that do not pull. For linear springs see
// Schwager and Poeschel 2007 (Granular Matter 9, 465). For Hertz's law, with a dashpot that goes as the fourth root of
// the overlap, the curve is the same (Antypov and Elliott 2011, EPL 94,
// 50004).
double dampingRatio(double restitution);

struct ContactTime {
    // The fastest expected impact (m/s). It follows from the speeds of spheres relative to each other and to walls and
    // obstacles, and from the possible fall. If no sphere moves or falls, it is a thirtieth of the smallest radius in a
    // step.
    double speed = 0;
    double contact = 0;  // s: the shortest contact at that speed, without damping
    double substep = 0;  // s: the longest
    double overlap = 0;  // of the smallest radius, that such an impact reaches
};

// A Young's modulus at which the overlap exceeds half the radius: at the fastest impact, under the weight of a pile of
// all spheres, or under a sphere's own weight.
struct TooSoft {
    std::uint8_t material = 0;
    double smallestYoung = 0;  // Pa, that bears it
    double share = 0;          // how many times too soft the contact is
};
// The softest contact of a scene that follows Hertz; none where all bear what they have to.
std::optional<TooSoft> tooSoft(const Scene& scene);

// For the scene's smallest spheres: the substep is 1/70 of the shortest contact. With a Young's modulus it is also at
// most a tenth of the Rayleigh time.
ContactTime contactTimeOf(const Scene& scene);

}  // namespace spherule::scene
