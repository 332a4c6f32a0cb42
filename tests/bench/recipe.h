#pragma once

#include "core/result.h"
#include "scene/scene.h"
#include "sim/state.h"

namespace spherule::bench {

constexpr double radius = 0.05;   // m
constexpr unsigned layers = 20;   // approximate depth of the bed
constexpr unsigned substeps = 8;  // per step of 1/60 s

// The scene box-50k for any number of spheres N: a lattice of 2.2 r with a jitter of 0.1 r falls into an open box. The
// box has the width 2 r sqrt(N / 20), so that the bed has the same depth for every N. Restitution 0.5, no
// sleep.
Result<scene::Scene> box(std::uint32_t spheres, double friction = 0);

// Places the spheres of `scene` on a cubic lattice that starts at the floor.
struct Arrangement {
    double spacing = 0;  // in r
    double jitter = 0;   // in r, uniform in +-jitter per axis
    double fall = 0;     // m/s, downwards
    double stir = 0;     // m/s, uniform in +-stir per axis
};
sim::State arranged(const scene::Scene& scene, const Arrangement& arrangement);

// As dense as a bed: each sphere touches its neighbours.
constexpr Arrangement dense{.spacing = 2, .jitter = 0.01};

// Falling and nearly touching. The spacing differs from the width of the grid's cells on purpose. Where they are equal,
// as in the box at its start, the number of spheres per cell depends on the total number of spheres.
constexpr Arrangement falling{.spacing = 2.4, .jitter = 0.2, .fall = 2, .stir = 0.5};

// Returns the mean overlap / radius of all overlapping pairs. The spheres are equal; w is the radius (m).
double meanOverlap(std::vector<glm::vec4> positions);

}  // namespace spherule::bench
