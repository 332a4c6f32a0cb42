#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "sim/sizes.h"

namespace spherule::sim {

// Cells for spheres of like size: a torus of cubes, so that memory is bounded wherever spheres go.
struct Level {
    float cellSize = 0;       // m
    float largest = 0;        // radius, m
    glm::uvec3 cells{0};      // per axis, multiples of 4
    std::uint32_t first = 0;  // of its cells among those of all levels
    std::uint32_t spheres = 0;
    float crowd = 0;  // more spheres than this in a cell can only be in each other

    [[nodiscard]] std::uint32_t all() const { return cells.x * cells.y * cells.z; }
};

// The broad phase's cells.
struct Grid {
    float margin = 0;                                   // m; pairs are listed up to this gap
    std::vector<Level> levels = std::vector<Level>(1);  // from the finest to the coarsest; one where radii are alike

    [[nodiscard]] std::uint32_t all() const { return levels.back().first + levels.back().all(); }
    [[nodiscard]] const Level& coarsest() const { return levels.back(); }
};

// Cells as wide as the largest sphere and the margin; as many as the domain needs, but at most about two per sphere.
// Beyond that, far places share cells: more tests, the same contacts.
Grid gridFor(glm::dvec3 extent, const Radii& radii);

}  // namespace spherule::sim
