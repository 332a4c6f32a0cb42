#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace spherule::scene {

class Mesh;

// Returns the point of the triangle a b c that is nearest to a point.
glm::dvec3 nearestOn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& point);

// Boxes around the triangles of a mesh, one in the other, to find the triangle nearest to a point. The mesh must
// outlive it. Any thread.
class TriangleTree {
  public:
    explicit TriangleTree(const Mesh& mesh);

    // Returns the distance of a point from the mesh (m); negative in a solid.
    [[nodiscard]] double distance(const glm::dvec3& point) const;

  private:
    struct Node {
        glm::dvec3 low{};
        glm::dvec3 high{};
        std::uint32_t first = 0;  // of its triangles in order_; of an inner node: the second of its two nodes
        std::uint32_t count = 0;  // 0: an inner node, whose first node follows it
    };
    struct Nearest;

    void build(std::uint32_t first, std::uint32_t end);
    void look(std::uint32_t node, const glm::dvec3& point, Nearest& nearest) const;

    const Mesh& mesh_;
    std::vector<std::uint32_t> order_;  // triangles
    std::vector<Node> nodes_;
};

}  // namespace spherule::scene
