#include <algorithm>
#include <cmath>

#include <spdlog/fmt/fmt.h>
#include <glm/geometric.hpp>

#include "scene/mesh/mesh.h"

namespace spherule::scene {

namespace {

struct HalfEdge {
    std::uint64_t vertices;  // the lower number above the higher one
    std::uint32_t place;     // 3 times its triangle, plus its number there
    auto operator<=>(const HalfEdge&) const = default;
};

std::vector<HalfEdge> halfEdgesOf(const Mesh& mesh) {
    std::vector<HalfEdge> all;
    all.reserve(3 * mesh.corners.size());
    for (std::uint32_t t = 0; t < mesh.corners.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint64_t a = mesh.corners[t][k];
            const std::uint64_t b = mesh.corners[t][(k + 1) % 3];
            all.push_back({std::min(a, b) << 32U | std::max(a, b), 3 * t + k});
        }
    std::ranges::sort(all);
    return all;
}

// True if the triangle goes along the edge from the lower vertex to the higher one.
bool goesAlong(const Mesh& mesh, std::uint32_t triangle, const Mesh::Edge& edge) {
    for (std::size_t k = 0; k < 3; ++k)
        if (mesh.corners[triangle][k] == edge.vertices[0])
            return mesh.corners[triangle][(k + 1) % 3] == edge.vertices[1];
    return false;
}

bool agrees(const Mesh& mesh, const Mesh::Edge& edge) {
    return goesAlong(mesh, edge.triangles[0], edge) != goesAlong(mesh, edge.triangles[1], edge);
}

// Turns triangles so that neighbours have normals on the same side. Returns false if none had to be turned.
bool turnAlike(Mesh& mesh) {
    bool any = false;
    std::vector<bool> seen(mesh.corners.size());
    std::vector<std::uint32_t> open;
    for (std::uint32_t seed = 0; seed < mesh.corners.size(); ++seed) {
        if (seen[seed]) continue;
        seen[seed] = true;
        open.push_back(seed);
        while (!open.empty()) {
            const std::uint32_t t = open.back();
            open.pop_back();
            for (const std::uint32_t word : mesh.edgesOf[t]) {
                const Mesh::Edge& edge = mesh.edges[word / 2];
                const std::uint32_t other = edge.triangles[1 - word % 2];
                if (other == Mesh::none || seen[other]) continue;
                if (!agrees(mesh, edge)) {
                    std::swap(mesh.corners[other][1], mesh.corners[other][2]);
                    any = true;
                }
                seen[other] = true;
                open.push_back(other);
            }
        }
    }
    return any;
}

void makeEdges(Mesh& mesh) {
    mesh.edges.clear();
    mesh.report.borders = 0;
    mesh.report.crowded = 0;
    mesh.edgesOf.assign(mesh.corners.size(), {});
    const std::vector<HalfEdge> all = halfEdgesOf(mesh);
    for (std::size_t first = 0; first < all.size();) {
        std::size_t end = first;
        while (end < all.size() && all[end].vertices == all[first].vertices) ++end;
        const std::size_t count = end - first;
        if (count > 2) ++mesh.report.crowded;
        // Around an edge of more than two triangles, each has a border of its own.
        for (std::size_t k = first; k < end; ++k) {
            const std::uint32_t triangle = all[k].place / 3;
            std::uint32_t side = 1;
            if (count != 2 || k == first) {
                side = 0;
                mesh.edges.push_back({.vertices = {static_cast<std::uint32_t>(all[k].vertices >> 32U),
                                                   static_cast<std::uint32_t>(all[k].vertices & 0xffffffffU)}});
            }
            mesh.edges.back().triangles[side] = triangle;
            const auto number = static_cast<std::uint32_t>(mesh.edges.size() - 1);
            mesh.edgesOf[triangle][all[k].place % 3] = 2 * number + side;
        }
        if (count == 1) ++mesh.report.borders;
        first = end;
    }
}

// In the units of the file.
std::string placeOf(const Mesh& mesh, const Mesh::Edge& edge, double scale) {
    const auto place = [&](std::size_t k) {
        const glm::dvec3 p = (mesh.vertices[edge.vertices[k]] + mesh.centre) / scale;
        return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
    };
    return fmt::format("from {} to {}", place(0), place(1));
}

// Returns the number of borders that have a vertex of another one between their ends.
std::size_t junctions(const Mesh& mesh) {
    constexpr std::size_t mostLooked = 1000;
    constexpr double onEdge = 1e-6;  // of the edge
    std::vector<const Mesh::Edge*> borders;
    for (const Mesh::Edge& edge : mesh.edges)
        if (edge.triangles[1] == Mesh::none && borders.size() < mostLooked) borders.push_back(&edge);
    std::size_t found = 0;
    for (const Mesh::Edge* const edge : borders) {
        const glm::dvec3& from = mesh.vertices[edge->vertices[0]];
        const glm::dvec3 along = mesh.vertices[edge->vertices[1]] - from;
        const double squared = glm::dot(along, along);
        const auto lies = [&](const Mesh::Edge* other) {
            const glm::dvec3 d = mesh.vertices[other->vertices[0]] - from;
            const double share = glm::dot(d, along) / squared;
            return share > onEdge && share < 1 - onEdge && glm::length(d - share * along) < onEdge * std::sqrt(squared);
        };
        if (std::ranges::any_of(borders, lies)) ++found;
    }
    return found;
}

}  // namespace

void findEdges(Mesh& mesh) {
    makeEdges(mesh);
    if (!mesh.closed() && turnAlike(mesh)) makeEdges(mesh);
}

void checkClosed(Check& check, const MeshBytes& from, const Mesh& mesh, double scale) {
    const Mesh::Report& report = mesh.report;
    const auto firstWhere = [&](auto property) {
        return placeOf(mesh, *std::ranges::find_if(mesh.edges, property), scale);
    };
    const auto isBorder = [](const Mesh::Edge& edge) { return edge.triangles[1] == Mesh::none; };
    if (report.borders > 0) {
        const std::size_t between = junctions(mesh);
        return from.refuse(
            check, "",
            fmt::format("is not closed: {} edges have one triangle only, the first {}{}; close it, or leave `solid` "
                        "and `hollow` out for a thin sheet",
                        report.borders, firstWhere(isBorder),
                        between == 0
                            ? ""
                            : fmt::format(", and at {} of them vertices of others lie between the ends", between)));
    }
    if (report.crowded > 0)
        return from.refuse(check, "",
                           fmt::format("has {} edges of more than two triangles, the first {}; separate the parts, or "
                                       "make one surface of them",
                                       report.crowded, firstWhere(isBorder)));
    const auto turned = [&](const Mesh::Edge& edge) { return !agrees(mesh, edge); };
    if (const auto count = std::ranges::count_if(mesh.edges, turned); count > 0)
        return from.refuse(check, "",
                           fmt::format("has neighbours that face opposite ways at {} edges, the first {}; turn all "
                                       "normals outward",
                                       count, firstWhere(turned)));
    const double volume = mesh.volume();
    if (!(volume > 0))
        from.refuse(check, "",
                    fmt::format("encloses a volume of {:.3g} m³, because its normals point inward; turn "
                                "them outward",
                                volume));
}

}  // namespace spherule::scene
