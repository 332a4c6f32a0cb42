#pragma once

#include "core/result.h"
#include "scene/scene.h"
#include "sim/state.h"

namespace spherule::bench {

constexpr double radius = 0.05;   // m
constexpr unsigned layers = 20;   // of the bed, about
constexpr unsigned substeps = 8;  // per step of 1/60 s

// The scene box-50k for any number of spheres: a lattice of 2.2 r with a jitter of 0.1 r falls into an open box of the
// width 2 r sqrt(N / 20), so that the bed is equally deep at all sizes. e = 0.5, no friction, nobody sleeps.
Result<scene::Scene> box(std::uint32_t spheres);

// The spheres of `scene` on a cubic lattice from the floor up.
struct Arrangement {
    double spacing = 0;  // in r
    double jitter = 0;   // in r, uniform in +-jitter per axis
    double fall = 0;     // m/s, downwards
    double stir = 0;     // m/s, uniform in +-stir per axis
};
sim::State arranged(const scene::Scene& scene, const Arrangement& arrangement);

// As dense as a bed at once: each sphere touches its neighbours.
constexpr Arrangement dense{.spacing = 2, .jitter = 0.01};

// Halfway down, nearly touching. Its spacing has nothing to do with the width of the grid's cells: where they agree, as
// in the box before it falls, the cells hold one sphere each or many, depending on the number of spheres.
constexpr Arrangement falling{.spacing = 2.4, .jitter = 0.2, .fall = 2, .stir = 0.5};

// Mean overlap of the overlapping pairs of equal spheres (w = radius), as a share of the radius.
double meanOverlap(std::vector<glm::vec4> positions);

}  // namespace spherule::bench
