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

// The effective modulus of all linear springs, Pa; 0 with Hertz's law, which has that of the materials. Where the
// substeps are pinned, as stiff as they allow: a contact of the smallest spheres then takes 70 of them. Where they are
// not, such that the fastest impact reaches the wanted overlap (m* v^2 = k d^2), and the weight of all spheres a fifth
// of it.
double springModulus(const Scene& scene);

Stiffness stiffnessBetween(const Scene& scene, std::uint8_t a, std::uint8_t b, double springModulus);

// The damping ratio of a dashpot that makes two bodies part with `restitution` times the speed of their meeting, where
// contacts do not pull. For linear springs by Schwager and Poeschel 2007 (Granular Matter 9, 465); for Hertz's law,
// with a dashpot that goes as the fourth root of the overlap, the curve is the same (Antypov and Elliott 2011, EPL 94,
// 50004).
double dampingRatio(double restitution);

struct ContactTime {
    // m/s: the fastest impact to expect, from how fast spheres move relative to each other, or to walls and obstacles
    // where there are any, and from the fall there may be. Where nothing moves or falls: a thirtieth of the smallest
    // radius in a step.
    double speed = 0;
    double contact = 0;  // s: the shortest contact at that speed, without damping
    double substep = 0;  // s: the longest
    double overlap = 0;  // of the smallest radius, that such an impact reaches
};

// Young's modulus of a material with which spheres give way by more than half their radius: under the fastest impact,
// or under the weight that a pile of all spheres puts on them, or their own.
struct TooSoft {
    std::uint8_t material = 0;
    double smallestYoung = 0;  // Pa, that bears it
    double share = 0;          // how many times too soft the contact is
};
// The softest contact of a scene that follows Hertz; none where all bear what they have to.
std::optional<TooSoft> tooSoft(const Scene& scene);

// Of the scene's smallest spheres: the substep is a seventieth of the shortest contact, and a tenth of the Rayleigh
// time where there is a Young's modulus.
ContactTime contactTimeOf(const Scene& scene);

}  // namespace spherule::scene
