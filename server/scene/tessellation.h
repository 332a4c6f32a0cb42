#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "scene/frame.h"
#include "scene/scene.h"

namespace spherule::v1 {
class MeshFacts;
class Obstacle;
}  // namespace spherule::v1

namespace spherule::scene {

// A surface of triangles. Their corners are in counter-clockwise order for a viewer in the free space.
struct Tessellation {
    std::vector<glm::dvec3> points;   // m
    std::vector<glm::uvec3> corners;  // of each triangle: numbers of points

    void append(const Tessellation& other);
};

// Returns the surface of an obstacle that is moved to `pose` from its place in the scene. Round shapes have 64 sides.
// A plane ends at the bounds. Returns an empty surface if scenes cannot have the obstacle.
// `mesh`: the triangles of an obstacle that is a mesh, or null. A mesh without its triangles is the box around them.
Tessellation tessellationOf(const v1::Obstacle& obstacle, const v1::MeshFacts* mesh, const Frame& pose,
                            const Box& bounds);

}  // namespace spherule::scene
