#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/mesh/mesh.h"
#include "sim/mesh_tree.h"

namespace spherule::sim {

// Cells around a mesh, in its own coordinates. Each has two lists of the nodes (MeshTree::tops) that come within
// `reach` of a point in the cell, in ascending order: first those within `nearReach`, then the others. The number of
// cells and of entries grows with the number of triangles alone.
struct MeshGrid {
    glm::dvec3 low{};                    // m: lowest corner
    double width = 0;                    // m, of a cell
    glm::uvec3 cells{};                  // along each axis
    double reach = 0;                    // m
    double nearReach = 0;                // m
    std::vector<std::uint32_t> first{};  // entry of each list, of cells along x first; then the number of all entries
    std::vector<std::uint32_t> nodes{};  // entries
    std::vector<std::uint16_t> steps{};  // cells to the nearest one with nodes, also diagonally; 0: it has some

    static MeshGrid around(const scene::Mesh& mesh, const MeshTree& tree, double reach, double nearReach);

    [[nodiscard]] std::size_t count() const { return steps.size(); }
    // Returns a distance (m): no point of the empty cell is nearer to the mesh.
    [[nodiscard]] double roomOf(std::size_t cell) const { return reach + (steps[cell] - 1) * width; }
};

}  // namespace spherule::sim
