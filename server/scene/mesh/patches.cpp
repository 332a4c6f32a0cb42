#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>

#include "scene/mesh/mesh.h"

namespace spherule::scene {

namespace {

constexpr double flatAngle = 1.745e-4;       // rad: 0.01 degrees
constexpr double flatness = 2e-6;            // of the longest side: largest distance of a patch from its plane
constexpr double rounding = 2.5e-7;          // of the largest coordinate, in float32
constexpr double needleShare = 1e-6;         // height over length
constexpr double smoothCosine = 0.98480775;  // of 10 degrees

class Patches {
  public:
    Patches(Mesh& mesh, double largestCoordinate)
        : mesh_(mesh),
          noise_(rounding * largestCoordinate),
          most_(flatness * 2 * std::max({mesh.half.x, mesh.half.y, mesh.half.z}) + noise_),
          area_(mesh.corners.size()),
          needle_(mesh.corners.size()) {
        for (std::uint32_t t = 0; t < area_.size(); ++t) {
            area_[t] = glm::cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0));
            const double longest = lengthOf(t, longestEdge(t));
            needle_[t] = glm::length(area_[t]) < needleShare * longest * longest;
            if (needle_[t]) ++mesh.report.needles;
        }
        mesh.patchOf.assign(area_.size(), Mesh::none);
        mesh.patches.clear();
    }

    // The largest triangles come first, because their normals are the most exact.
    void find() {
        std::vector<std::uint32_t> order(area_.size());
        std::iota(order.begin(), order.end(), 0U);
        std::ranges::stable_sort(order, std::greater(), [&](std::uint32_t t) { return glm::dot(area_[t], area_[t]); });
        for (const std::uint32_t seed : order) {
            if (mesh_.patchOf[seed] != Mesh::none) continue;
            Mesh::Patch plane = planeOf(seed);
            const auto number = static_cast<std::uint32_t>(mesh_.patches.size());
            std::vector<std::uint32_t> members = flood(seed, plane, number);
            if (members.size() > 1) {
                plane = fitted(members, plane);
                for (const std::uint32_t t : members) mesh_.patchOf[t] = Mesh::none;
                members = flood(seed, plane, number);
                plane = fitted(members, plane);
            }
            mesh_.patches.push_back(plane);
        }
    }

  private:
    [[nodiscard]] double lengthOf(std::uint32_t t, unsigned k) const {
        return glm::distance(mesh_.corner(t, k), mesh_.corner(t, (k + 1) % 3));
    }

    [[nodiscard]] unsigned longestEdge(std::uint32_t t) const {
        unsigned longest = 0;
        for (unsigned k = 1; k < 3; ++k)
            if (lengthOf(t, k) > lengthOf(t, longest)) longest = k;
        return longest;
    }

    [[nodiscard]] Mesh::Patch planeOf(std::uint32_t t) const {
        glm::dvec3 normal = area_[t];
        if (!(glm::length(normal) > 0)) {  // any direction across a needle that has no neighbour
            const glm::dvec3 along = mesh_.corner(t, 1) - mesh_.corner(t, 0);
            normal =
                glm::cross(along, std::abs(along.x) < std::abs(along.y) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
            if (!(glm::length(normal) > 0)) normal = glm::cross(along, glm::dvec3(0, 0, 1));
        }
        normal = glm::normalize(normal);
        return {normal, glm::dot(normal, (mesh_.corner(t, 0) + mesh_.corner(t, 1) + mesh_.corner(t, 2)) / 3.0)};
    }

    // Returns the plane through the centre of the triangles, with their mean normal.
    [[nodiscard]] Mesh::Patch fitted(const std::vector<std::uint32_t>& members, const Mesh::Patch& seed) const {
        glm::dvec3 sum{};
        glm::dvec3 moment{};
        double weight = 0;
        for (const std::uint32_t t : members) {
            const double area = glm::length(area_[t]);
            sum += area_[t];
            moment += area * (mesh_.corner(t, 0) + mesh_.corner(t, 1) + mesh_.corner(t, 2)) / 3.0;
            weight += area;
        }
        if (!(glm::length(sum) > 0.5 * weight)) return seed;
        const glm::dvec3 normal = glm::normalize(sum);
        return {normal, glm::dot(normal, moment) / weight};
    }

    // Returns true if a triangle that shares the edge `k` with a patch lies in its plane.
    [[nodiscard]] bool isFlat(std::uint32_t t, unsigned k, const Mesh::Patch& plane) const {
        if (needle_[t]) return k == longestEdge(t);
        if (!(glm::dot(area_[t], plane.normal) > 0)) return false;
        const double height = glm::length(area_[t]) / lengthOf(t, k);
        const double above = std::abs(glm::dot(plane.normal, mesh_.corner(t, (k + 2) % 3)) - plane.offset);
        return above <= std::min(flatAngle * height + noise_, most_);
    }

    // Gives all triangles that lie in the plane, from one to the next, the number of the patch.
    std::vector<std::uint32_t> flood(std::uint32_t seed, const Mesh::Patch& plane, std::uint32_t number) {
        std::vector<std::uint32_t> members{seed};
        mesh_.patchOf[seed] = number;
        for (std::size_t done = 0; done < members.size(); ++done) {
            for (const std::uint32_t word : mesh_.edgesOf[members[done]]) {
                const std::uint32_t other = mesh_.edges[word / 2].triangles[1 - word % 2];
                if (other == Mesh::none || mesh_.patchOf[other] != Mesh::none) continue;
                unsigned k = 0;
                while (mesh_.edgesOf[other][k] / 2 != word / 2) ++k;
                if (!isFlat(other, k, plane)) continue;
                mesh_.patchOf[other] = number;
                members.push_back(other);
            }
        }
        return members;
    }

    Mesh& mesh_;
    double noise_;                  // m
    double most_;                   // m
    std::vector<glm::dvec3> area_;  // m^2: twice the area, along the normal
    std::vector<bool> needle_;
};

// Sets which edges spheres can touch. The wedge beyond an edge of a solid is outside only if the edge is convex.
void findMeetingEdges(Mesh& mesh) {
    for (Mesh::Edge& edge : mesh.edges) {
        const auto [first, second] = edge.triangles;
        if (second == Mesh::none) {
            edge.meets = true;
            continue;
        }
        edge.flat = mesh.patchOf[first] == mesh.patchOf[second];
        if (edge.flat) continue;
        edge.meets = true;
        if (mesh.closed()) edge.meets = !mesh.risesBeyond(edge);
    }
}

void findSmoothGroups(Mesh& mesh) {
    mesh.smoothOf.resize(mesh.patches.size());
    std::iota(mesh.smoothOf.begin(), mesh.smoothOf.end(), 0U);
    const auto rootOf = [&](std::uint32_t patch) {
        while (mesh.smoothOf[patch] != patch) {
            mesh.smoothOf[patch] = mesh.smoothOf[mesh.smoothOf[patch]];
            patch = mesh.smoothOf[patch];
        }
        return patch;
    };
    for (const Mesh::Edge& edge : mesh.edges) {
        if (edge.triangles[1] == Mesh::none || edge.flat) continue;
        if (glm::dot(mesh.normal(edge.triangles[0]), mesh.normal(edge.triangles[1])) < smoothCosine) continue;
        const std::uint32_t a = rootOf(mesh.patchOf[edge.triangles[0]]);
        const std::uint32_t b = rootOf(mesh.patchOf[edge.triangles[1]]);
        mesh.smoothOf[std::max(a, b)] = std::min(a, b);
    }
    for (std::uint32_t patch = 0; patch < mesh.patches.size(); ++patch) mesh.smoothOf[patch] = rootOf(patch);
}

void findVertexNormals(Mesh& mesh) {
    mesh.vertexNormals.assign(mesh.vertices.size(), glm::dvec3(0));
    for (std::uint32_t t = 0; t < mesh.corners.size(); ++t)
        for (unsigned k = 0; k < 3; ++k) {
            const glm::dvec3 a = mesh.corner(t, (k + 1) % 3) - mesh.corner(t, k);
            const glm::dvec3 b = mesh.corner(t, (k + 2) % 3) - mesh.corner(t, k);
            const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
            mesh.vertexNormals[mesh.corners[t][k]] += angle * mesh.normal(t);
        }
}

}  // namespace

bool Mesh::risesBeyond(const Edge& edge) const {
    const auto [first, second] = edge.triangles;
    unsigned k = 0;
    while (corners[second][k] == edge.vertices[0] || corners[second][k] == edge.vertices[1]) ++k;
    return !(glm::dot(normal(first), corner(second, k) - vertices[edge.vertices[0]]) < 0);
}

void findPatches(Mesh& mesh, double largestCoordinate) {
    Patches(mesh, largestCoordinate).find();
    findMeetingEdges(mesh);
    findSmoothGroups(mesh);
    findVertexNormals(mesh);
}

}  // namespace spherule::scene
