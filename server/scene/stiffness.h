#pragma once

#include <cstdint>
#include <optional>

#include "scene/scene.h"

// The stiffness of contacts and the length of substeps in the model `accurate`.
namespace spherule::scene {

struct Stiffness {
    double normal = 0;      // Pa: effective modulus; of linear springs k = 2 normal R*
    double damping = 0;     // damping ratio
    double tangential = 0;  // Pa: Mindlin's effective shear modulus; of linear springs k_t = 2 tangential R*
};

// Returns true if contacts follow Hertz and Mindlin: some material has a Young's modulus. (Then all must have one.)
bool followsHertz(const Scene& scene);

// Returns the effective modulus of all linear springs (Pa); 0 with Hertz's law, which uses the moduli of the materials.
// With fixed substeps it is the largest that they allow: a contact of the smallest spheres then takes 70 of them.
// Otherwise the fastest impact reaches the wanted overlap (m* v^2 = k d^2), and the weight of all spheres reaches a
// fifth of it.
double springModulus(const Scene& scene);

Stiffness stiffnessBetween(const Scene& scene, std::uint8_t a, std::uint8_t b, double springModulus);

// Returns the damping ratio of a dashpot that gives `restitution`, for contacts that do not pull. For linear springs
// see Schwager and Poeschel 2007 (Granular Matter 9, 465). For Hertz's law, with a dashpot that goes as the fourth root
// of the overlap, the curve is the same (Antypov and Elliott 2011, EPL 94, 50004).
double dampingRatio(double restitution);

struct ContactTime {
    // The fastest expected impact (m/s). It follows from the speeds of spheres relative to each other and to walls and
    // obstacles, and from the possible fall. If no sphere moves or falls, it is a thirtieth of the smallest radius in a
    // step.
    double speed = 0;
    double contact = 0;  // s: the shortest contact at that speed, without damping
    double substep = 0;  // s: the longest substep allowed
    double overlap = 0;  // largest overlap of such an impact, as a share of the smallest radius
};

// A Young's modulus that is too small: the overlap exceeds half the radius. This may happen at the fastest impact,
// under the weight of a pile of all spheres, or under a sphere's own weight.
struct TooSoft {
    std::uint8_t material = 0;
    double smallestYoung = 0;  // Pa: the smallest modulus that is large enough
    double share = 0;          // needed modulus of the contact over its modulus
};
// Returns the contact that is too soft by the largest factor; nullopt if all are stiff enough. Only for scenes that
// follow Hertz.
std::optional<TooSoft> tooSoft(const Scene& scene);

// Returns the times for the scene's smallest spheres. The substep is 1/70 of the shortest contact. With a Young's
// modulus it is also at most a tenth of the Rayleigh time.
ContactTime contactTimeOf(const Scene& scene);

}  // namespace spherule::scene
