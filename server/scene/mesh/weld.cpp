#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/mesh/mesh.h"

namespace spherule::scene {

namespace {

constexpr double nearby = 1e-6;  // of the longest side of the box

// Vertices by cells twice as wide as the distance within which they are joined.
class VertexTable {
  public:
    VertexTable(const glm::dvec3& low, double distance, std::size_t count)
        : low_(low), distance_(distance), heads_(std::bit_ceil(std::max<std::size_t>(count, 16)), Mesh::none) {}

    // Returns the number of the vertex at a place, or of one nearby. `moved` counts the latter.
    std::uint32_t numberOf(const glm::dvec3& place, std::vector<glm::dvec3>& vertices, std::size_t& moved) {
        const glm::dvec3 scaled = (place - low_) / (2 * distance_);
        const glm::dvec3 cell = glm::floor(scaled);
        for (int k = 0; k < 8; ++k) {
            // The neighbour on the nearer side of each axis, or the cell itself.
            glm::dvec3 other = cell;
            for (int axis = 0; axis < 3; ++axis)
                if ((k >> axis & 1) != 0) other[axis] += scaled[axis] - cell[axis] < 0.5 ? -1 : 1;
            for (std::uint32_t v = heads_[placeOf(other)]; v != Mesh::none; v = next_[v]) {
                const double apart = glm::distance(vertices[v], place);
                if (apart > distance_) continue;
                if (apart > 0) ++moved;
                return v;
            }
        }
        const auto number = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(place);
        std::uint32_t& head = heads_[placeOf(cell)];
        next_.push_back(head);
        head = number;
        return number;
    }

  private:
    [[nodiscard]] std::size_t placeOf(const glm::dvec3& cell) const {
        std::uint64_t hash = 0;
        for (int axis = 0; axis < 3; ++axis) {
            hash ^= static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[axis]));
            hash *= 0x9e3779b97f4a7c15U;
            hash ^= hash >> 29U;
        }
        return hash & (heads_.size() - 1);
    }

    glm::dvec3 low_;
    double distance_;
    std::vector<std::uint32_t> heads_;
    std::vector<std::uint32_t> next_;
};

// Drops triangles that have the corners of an earlier one, in any order.
void dropDuplicates(Mesh& mesh) {
    struct Sorted {
        std::uint64_t low;  // the two lower corners
        std::uint32_t high;
        std::uint32_t number;
        auto operator<=>(const Sorted&) const = default;
    };
    std::vector<Sorted> all;
    all.reserve(mesh.corners.size());
    for (std::uint32_t t = 0; t < mesh.corners.size(); ++t) {
        std::array<std::uint32_t, 3> corners = mesh.corners[t];
        std::ranges::sort(corners);
        all.push_back({std::uint64_t{corners[0]} << 32U | corners[1], corners[2], t});
    }
    std::ranges::sort(all);
    std::vector<bool> drop(mesh.corners.size());
    for (std::size_t k = 1; k < all.size(); ++k)
        if (all[k].low == all[k - 1].low && all[k].high == all[k - 1].high) drop[all[k].number] = true;
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh.corners.size(); ++t)
        if (!drop[t]) mesh.corners[kept++] = mesh.corners[t];
    mesh.report.duplicated = mesh.corners.size() - kept;
    mesh.corners.resize(kept);
}

}  // namespace

void weld(Mesh& mesh, const Triangles& triangles, double scale) {
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    glm::dvec3 high(-std::numeric_limits<double>::infinity());
    for (const auto& corners : triangles.corners)
        for (const std::uint32_t corner : corners) {
            low = glm::min(low, triangles.vertices[corner] * scale);
            high = glm::max(high, triangles.vertices[corner] * scale);
        }
    mesh.centre = 0.5 * (low + high);
    mesh.half = 0.5 * (high - low);
    mesh.report.triangles = triangles.corners.size();
    const double longest = 2 * std::max({mesh.half.x, mesh.half.y, mesh.half.z});
    if (!(longest > 0)) return;
    VertexTable table(-mesh.half, nearby * longest, triangles.vertices.size());
    std::vector<std::uint32_t> numbers(triangles.vertices.size(), Mesh::none);
    for (const auto& corners : triangles.corners) {
        std::array<std::uint32_t, 3> welded{};
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& number = numbers[corners[k]];
            if (number == Mesh::none)
                number = table.numberOf(triangles.vertices[corners[k]] * scale - mesh.centre, mesh.vertices,
                                        mesh.report.moved);
            welded[k] = number;
        }
        if (welded[0] == welded[1] || welded[1] == welded[2] || welded[2] == welded[0])
            ++mesh.report.collapsed;
        else
            mesh.corners.push_back(welded);
    }
    dropDuplicates(mesh);
}

}  // namespace spherule::scene
