#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/mesh/triangles.h"

// Meshes for tests. Closed ones have outward normals.
namespace spherule::support {

scene::Triangles boxOf(const glm::dvec3& low, const glm::dvec3& high);

// Turns a line around the z axis. `line`: distance from the axis and z (m), from below to above along the outer side. A
// point on the axis closes the end.
scene::Triangles lathe(const std::vector<glm::dvec2>& line, unsigned sides);

// A plane at z = 0 between `low` and `high`, of 2 x columns x rows triangles. Its inner vertices and its diagonals are
// at random. `bump`: the inner vertices are up to this much higher (m).
scene::Triangles randomSheet(const glm::dvec2& low, const glm::dvec2& high, unsigned columns, unsigned rows,
                             unsigned seed, double bump = 0);

// A ball with bumps, of 20 x 4^level triangles.
scene::Triangles bumpyBall(double radius, double bump, unsigned level);

// A binary STL.
std::string stlOf(const scene::Triangles& triangles);

}  // namespace spherule::support
