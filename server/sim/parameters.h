#pragma once

#include <vector>

#include "scene/scene.h"
#include "sim/layout.h"
#include "sim/pipeline.h"
#include "sim/plan.h"

namespace spherule::sim {

// Returns the uniform block for a scene and its plan, with substeps of `substep` seconds.
layout::Parameters parametersFor(const scene::Scene& scene, const Plan& plan, const RadiusStats& radii, double substep);

// Returns the contact parameters for all pairs of materials, row by row.
std::vector<layout::ContactParams> contactParamsTable(const scene::Scene& scene);

// Returns the rows of the obstacles for kernels, in the order of the scene. `meshes`: null if there are none.
std::vector<layout::Obstacle> obstaclesFor(const scene::Scene& scene, const MeshTables* meshes);

// Writes the scene data that kernels read in addition to the spheres and the parameters.
void writeConstants(Pipeline& pipeline, const scene::Scene& scene);

// Returns the sinks as the device compares them: relative to the bounds' centre (m), rounded to float32.
std::vector<scene::Box> sinksOnDevice(const scene::Scene& scene);

}  // namespace spherule::sim
