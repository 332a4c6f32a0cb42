#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/mesh/mesh.h"

namespace spherule::sim {

// Groups of triangles near each other, so that spheres pass over many small triangles at a time. A triangle that is
// large for the spheres is alone.
struct MeshClusters {
    struct Cluster {
        std::uint32_t first = 0;  // of its triangles in `order`
        std::uint32_t count = 0;
        glm::dvec3 low{};  // m: its box, in the coordinates of the mesh
        glm::dvec3 high{};

        [[nodiscard]] glm::dvec3 centre() const { return 0.5 * (low + high); }
        [[nodiscard]] glm::dvec3 half() const { return 0.5 * (high - low); }
    };
    std::vector<std::uint32_t> order{};  // the triangles of the mesh
    std::vector<Cluster> clusters{};

    // `reach`: the distance at which spheres look for triangles (m).
    static MeshClusters of(const scene::Mesh& mesh, double reach);
};

}  // namespace spherule::sim
