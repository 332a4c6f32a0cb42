#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scene/mesh/mesh.h"

namespace spherule::sim {

// A tree of two levels over the triangles of a mesh, so that spheres pass over many small triangles at a time. A leaf
// has up to 16 triangles, a group up to 16 leaves. A triangle that is large for the spheres is alone in its leaf.
struct MeshTree {
    struct Node {
        std::uint32_t first = 0;   // of its triangles in `order`
        std::uint32_t count = 0;   // of its triangles
        std::uint32_t leaves = 0;  // of a group; they follow it in `nodes`. 0: it is a leaf
        glm::dvec3 low{};          // m: its box, in the coordinates of the mesh
        glm::dvec3 high{};

        [[nodiscard]] glm::dvec3 centre() const { return 0.5 * (low + high); }
        [[nodiscard]] glm::dvec3 half() const { return 0.5 * (high - low); }
    };
    std::vector<std::uint32_t> order{};  // the triangles of the mesh
    std::vector<Node> nodes{};
    std::vector<std::uint32_t> tops{};  // the nodes that no group has, in ascending order

    // `reach`: the distance at which spheres look for triangles (m).
    static MeshTree of(const scene::Mesh& mesh, double reach);
};

// Two planes around triangles, and a grid across them for boxes around parts of the triangles.
struct MeshSlab {
    const scene::Mesh& mesh;
    glm::dvec3 centre;                                // m: of the grid, in the coordinates of the mesh
    glm::dmat3 axes{};                                // of the grid: u, v, and the normal of the planes
    double margin;                                    // m: how much wider planes and boxes are
    double low = std::numeric_limits<double>::max();  // m: the planes, from the centre along the normal
    double high = -low;
    double steps = 0;  // of the grid (1/m)

    MeshSlab(const scene::Mesh& mesh, std::span<const std::uint32_t> triangles, const glm::dvec3& centre,
             double margin);

    // Returns the box around some of the triangles, in steps: lowest u, highest u, lowest v, highest v.
    [[nodiscard]] glm::uvec4 boxOf(std::span<const std::uint32_t> triangles) const;
};

}  // namespace spherule::sim
