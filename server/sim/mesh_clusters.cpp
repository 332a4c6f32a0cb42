#include "sim/mesh_clusters.h"

#include <algorithm>
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

constexpr double mostExtent = 0.5;  // of a cluster with several triangles: half its diagonal, over the reach

struct Box {
    glm::dvec3 low;
    glm::dvec3 high;

    [[nodiscard]] Box with(const Box& other) const { return {glm::min(low, other.low), glm::max(high, other.high)}; }
};

Box boxOf(const scene::Mesh& mesh, std::uint32_t triangle) {
    const glm::dvec3& a = mesh.corner(triangle, 0);
    const glm::dvec3& b = mesh.corner(triangle, 1);
    const glm::dvec3& c = mesh.corner(triangle, 2);
    return {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
}

glm::dvec3 centreOf(const Box& box) {
    return 0.5 * (box.low + box.high);
}

}  // namespace

MeshClusters MeshClusters::of(const scene::Mesh& mesh, double reach) {
    const auto count = static_cast<std::uint32_t>(mesh.corners.size());
    std::vector<Box> boxes;
    boxes.reserve(count);
    for (std::uint32_t t = 0; t < count; ++t) boxes.push_back(boxOf(mesh, t));
    MeshClusters made;
    made.order.resize(count);
    std::iota(made.order.begin(), made.order.end(), 0U);
    // Halves the triangles along the longest side, until each part is small enough.
    const auto split = [&](auto&& self, std::uint32_t first, std::uint32_t end) -> void {
        const auto part = std::span(made.order).subspan(first, end - first);
        Box all = boxes[part[0]];
        Box centres{centreOf(all), centreOf(all)};
        for (const std::uint32_t t : part) {
            all = all.with(boxes[t]);
            centres = centres.with({centreOf(boxes[t]), centreOf(boxes[t])});
        }
        const bool small = 0.5 * glm::distance(all.low, all.high) <= mostExtent * reach;
        if (part.size() == 1 || (part.size() <= MOST_IN_CLUSTER && small)) {
            made.clusters.push_back({.first = first, .count = end - first, .low = all.low, .high = all.high});
            return;
        }
        const glm::dvec3 size = centres.high - centres.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto along = [&](std::uint32_t t) { return std::pair(centreOf(boxes[t])[axis], t); };
        const auto half = static_cast<std::ptrdiff_t>(part.size() / 2);
        std::ranges::nth_element(part, part.begin() + half, {}, along);
        const std::uint32_t middle = first + static_cast<std::uint32_t>(half);
        self(self, first, middle);
        self(self, middle, end);
    };
    split(split, 0, count);
    return made;
}

}  // namespace spherule::sim
