#pragma once

#include <cstdint>

#include "mesh_triangles.h"
#include "scene/mesh/mesh.h"
#include "support.h"

// Scenes with obstacles of triangles.
namespace spherule::physics {

constexpr scene::Model models[] = {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate};

scene::Obstacle meshOf(scene::Triangles triangles, scene::Mesh::Form form);

// A space without walls and sleep, whose steps suit the model.
scene::Scene spaceFor(scene::Model model, double side);

glm::dvec3 placeOf(const sim::State& state, const scene::Scene& scene, std::size_t k = 0);

// Lets spheres of 1 cm fly at 100 m/s through a bottle, without losses. Tests that none is outside afterwards, and that
// their energy is the same within 1 %. The bottle is read from the bytes of an STL file. `substeps`: of a step of 1/480
// s; the program requires 42, and 929 in `accurate`. `mostChange`: of the energy of each sphere, as a share.
void flyInBottle(scene::Model model, double seconds, unsigned count, std::uint32_t substeps, double mostChange);

}  // namespace spherule::physics
