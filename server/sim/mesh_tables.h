#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec4.hpp>

#include "scene/scene.h"

namespace spherule::scene {
class Mesh;
}

namespace spherule::sim {

// The meshes of a scene as kernels read them: see shaders/shared/mesh_layout.h. Immutable.
struct MeshTables {
    struct Row {
        glm::vec4 a{};
        glm::vec4 b{};
        std::uint32_t cellsAt = 0;
        std::uint32_t nodesAt = 0;
        std::uint32_t firstKey = 0;  // of its contacts
        std::uint32_t endKey = 0;
    };
    std::vector<Row> rows{};             // of each obstacle; zero for other shapes
    std::vector<std::uint32_t> words{};  // behind the list of all obstacles
    std::vector<std::shared_ptr<const scene::Mesh>> meshes{};

    [[nodiscard]] std::uint64_t bytes() const { return words.size() * sizeof(std::uint32_t); }
};

// Returns the tables for spheres up to a radius (m). While something uses the tables, the next call for the same meshes
// returns them. Any thread.
std::shared_ptr<const MeshTables> meshTablesFor(const scene::Scene& scene, double largestRadius);

}  // namespace spherule::sim
