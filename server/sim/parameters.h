#pragma once

#include <vector>

#include "scene/scene.h"
#include "sim/layout.h"
#include "sim/pipeline.h"
#include "sim/plan.h"

namespace spherule::sim {

// The uniform block for a scene and its plan, with substeps of `substep` seconds.
layout::Parameters parametersFor(const scene::Scene& scene, const Plan& plan, const Radii& radii, double substep);

// Between all materials, row by row.
std::vector<layout::ContactParams> lawsFor(const scene::Scene& scene);

// Planes first, then boxes, relative to the bounds' centre.
std::vector<layout::Obstacle> obstaclesFor(const scene::Scene& scene);

// All that the kernels read of the scene besides the spheres and the parameters.
void writeConstants(Pipeline& pipeline, const scene::Scene& scene);

}  // namespace spherule::sim
