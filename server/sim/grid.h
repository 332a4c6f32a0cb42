#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

namespace spherule::sim {

// The broad phase's cells: a torus of cubes, so that memory is bounded wherever spheres go.
struct Grid {
    float cellSize = 0;   // m
    float margin = 0;     // m; pairs are listed up to this gap
    glm::uvec3 cells{0};  // per axis, multiples of 4

    [[nodiscard]] std::uint32_t all() const { return cells.x * cells.y * cells.z; }
};

// Cells as wide as the largest sphere and the margin; as many as the domain needs, but at most about two per sphere.
// Beyond that, far places share cells: more tests, the same contacts.
Grid gridFor(glm::dvec3 extent, double largestRadius, double meanRadius, std::uint32_t spheres);

}  // namespace spherule::sim
