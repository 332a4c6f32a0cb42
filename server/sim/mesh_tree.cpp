#include "sim/mesh_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace spherule::sim {

namespace layout {
#include "shared/mesh_layout.h"
}

namespace {

// The largest size of a node with several triangles: half its diagonal, over the reach.
constexpr double mostOfNode = 1.5;

struct Box {
    glm::dvec3 low;
    glm::dvec3 high;

    [[nodiscard]] Box with(const Box& other) const { return {glm::min(low, other.low), glm::max(high, other.high)}; }
    [[nodiscard]] glm::dvec3 centre() const { return 0.5 * (low + high); }
    [[nodiscard]] double size() const { return 0.5 * glm::distance(low, high); }
};

class Builder {
  public:
    Builder(const scene::Mesh& mesh, double reach) : reach_(reach) {
        const auto count = static_cast<std::uint32_t>(mesh.corners.size());
        for (std::uint32_t t = 0; t < count; ++t) {
            const glm::dvec3& a = mesh.corner(t, 0);
            const glm::dvec3& b = mesh.corner(t, 1);
            const glm::dvec3& c = mesh.corner(t, 2);
            boxes_.push_back({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))});
        }
        tree_.order.resize(count);
        std::iota(tree_.order.begin(), tree_.order.end(), 0U);
        split(0, count, false);
    }

    MeshTree take() { return std::move(tree_); }

  private:
    // Divides the triangles in `order` from `first` to `end` into nodes. It halves them along the longest side until
    // each part is small enough.
    void split(std::uint32_t first, std::uint32_t end, bool inGroup) {
        const auto part = std::span(tree_.order).subspan(first, end - first);
        Box all = boxes_[part[0]];
        Box centres{all.centre(), all.centre()};
        for (const std::uint32_t t : part) {
            all = all.with(boxes_[t]);
            centres = centres.with({boxes_[t].centre(), boxes_[t].centre()});
        }
        const bool small = part.size() == 1 || all.size() <= mostOfNode * reach_;
        const bool isLeaf = small && part.size() <= CHILDREN_OF_NODE;
        const bool isGroup = small && !isLeaf && !inGroup && part.size() <= CHILDREN_OF_NODE * CHILDREN_OF_NODE;
        const std::size_t place = tree_.nodes.size();
        if (isLeaf || isGroup) {
            if (!inGroup) tree_.tops.push_back(static_cast<std::uint32_t>(place));
            tree_.nodes.push_back(
                {.first = first, .count = end - first, .leaves = 0, .low = all.low, .high = all.high});
        }
        if (isLeaf) return;
        const glm::dvec3 size = centres.high - centres.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto along = [&](std::uint32_t t) { return std::pair(boxes_[t].centre()[axis], t); };
        const auto half = static_cast<std::ptrdiff_t>(part.size() / 2);
        std::ranges::nth_element(part, part.begin() + half, {}, along);
        const std::uint32_t middle = first + static_cast<std::uint32_t>(half);
        split(first, middle, inGroup || isGroup);
        split(middle, end, inGroup || isGroup);
        if (isGroup) tree_.nodes[place].leaves = static_cast<std::uint32_t>(tree_.nodes.size() - place - 1);
    }

    double reach_;
    std::vector<Box> boxes_;  // of the triangles
    MeshTree tree_;
};

}  // namespace

MeshTree MeshTree::of(const scene::Mesh& mesh, double reach) {
    return Builder(mesh, reach).take();
}

MeshSlab::MeshSlab(const scene::Mesh& ofMesh, std::span<const std::uint32_t> triangles, const glm::dvec3& around,
                   double wider)
    : mesh(ofMesh), centre(around), margin(wider) {
    glm::dvec3 normal(0);
    for (const std::uint32_t t : triangles) normal += mesh.normal(t);
    normal = glm::length(normal) > 0.1 ? glm::normalize(normal) : mesh.normal(triangles[0]);
    const glm::dvec3 least = glm::abs(normal);
    const glm::dvec3 axis = least.x <= least.y && least.x <= least.z ? glm::dvec3(1, 0, 0)
                            : least.y <= least.z                     ? glm::dvec3(0, 1, 0)
                                                                     : glm::dvec3(0, 0, 1);
    const glm::dvec3 across = glm::normalize(glm::cross(axis, normal));
    axes = glm::dmat3(across, glm::cross(normal, across), normal);
    double extent = 0;
    for (const std::uint32_t t : triangles)
        for (unsigned k = 0; k < 3; ++k) {
            const glm::dvec3 corner = (mesh.corner(t, k) - centre) * axes;
            low = std::min(low, corner.z);
            high = std::max(high, corner.z);
            extent = std::max({extent, std::abs(corner.x), std::abs(corner.y)});
        }
    low -= margin;
    high += margin;
    steps = double{STEPS_TO_CENTRE} / (1.001 * extent + 2 * margin);
}

glm::uvec4 MeshSlab::boxOf(std::span<const std::uint32_t> triangles) const {
    glm::dvec2 from(std::numeric_limits<double>::max());
    glm::dvec2 to = -from;
    for (const std::uint32_t t : triangles)
        for (unsigned k = 0; k < 3; ++k) {
            const glm::dvec2 corner((mesh.corner(t, k) - centre) * axes);
            from = glm::min(from, corner);
            to = glm::max(to, corner);
        }
    const glm::uvec2 lowest(glm::floor((from - margin) * steps + double{STEPS_TO_CENTRE}));
    const glm::uvec2 highest(glm::ceil((to + margin) * steps + double{STEPS_TO_CENTRE}));
    return {lowest.x, highest.x, lowest.y, highest.y};
}

}  // namespace spherule::sim
