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

// The spheres of `scene`, at rest on a cubic lattice from the floor up, each touching its neighbours but for a jitter
// of 0.01 r: as dense as a bed at once.
sim::State packed(const scene::Scene& scene);

// Mean overlap of the overlapping pairs of equal spheres (w = radius), as a share of the radius.
double meanOverlap(std::vector<glm::vec4> positions);

}  // namespace spherule::bench
