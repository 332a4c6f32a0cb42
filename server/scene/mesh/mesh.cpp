#include "scene/mesh/mesh.h"

#include <algorithm>
#include <cmath>

#include <spdlog/fmt/fmt.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/memory.h"
#include "scene/mesh/triangle_tree.h"

namespace spherule::scene {

namespace {

constexpr std::uint64_t bytesPerTriangle = 500;  // while a mesh is made
constexpr double largestShare = 100;             // of the bounds
constexpr double smallestShare = 1e-4;

// A file in other units than metres.
void checkSize(Check& check, const MeshBytes& from, const Mesh& mesh, const Mesh::Options& options) {
    const double longest = 2 * std::max({mesh.half.x, mesh.half.y, mesh.half.z});
    if (options.longestSide <= 0) return;
    if (longest > largestShare * options.longestSide)
        from.refuse(check, "",
                    fmt::format("is {:.6g} m long, more than {:g} times the bounds of {:.6g} m; if the file is in "
                                "millimetres, set `scale` to 0.001",
                                longest, largestShare, options.longestSide));
    if (longest < smallestShare * options.longestSide)
        from.refuse(check, "",
                    fmt::format("is {:.6g} m long, less than {:g} of the bounds of {:.6g} m; set `scale` to the metres "
                                "per unit of the file",
                                longest, smallestShare, options.longestSide));
}

void turnInside(Mesh& mesh) {
    for (auto& corners : mesh.corners) std::swap(corners[1], corners[2]);
}

double largestCoordinateOf(const Triangles& triangles) {
    double largest = 0;
    for (const glm::dvec3& v : triangles.vertices)
        largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return largest;
}

void add(std::string& text, std::size_t count, const char* what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
}

}  // namespace

std::string Mesh::Report::text() const {
    std::string text;
    add(text, moved, "vertices joined with one nearby");
    add(text, collapsed, "triangles without an area dropped");
    add(text, duplicated, "duplicated triangles dropped");
    add(text, needles, "needle triangles flattened");
    add(text, crowded, "edges of more than two triangles");
    return text.empty() ? text : fmt::format("{}, of {} triangles", text, triangles);
}

Mesh::Mesh() = default;
Mesh::~Mesh() = default;

std::shared_ptr<const Mesh> Mesh::make(Check& check, const MeshBytes& from, Triangles triangles,
                                       const Options& options) {
    if (!check.ok()) return nullptr;
    if (triangles.corners.empty()) {
        from.refuse(check, "", "has no triangles");
        return nullptr;
    }
    const auto room = memory::Claim::make(from.field, fmt::format("a mesh of {} triangles", triangles.corners.size()),
                                          bytesPerTriangle * triangles.corners.size());
    if (!room) {
        check.refuse(room.error());
        return nullptr;
    }
    auto mesh = std::make_shared<Mesh>();
    mesh->form = options.form;
    const double largest = largestCoordinateOf(triangles) * options.scale;
    if (!check.goesOn("joining a mesh", 0, 4)) return nullptr;
    weld(*mesh, triangles, options.scale);
    triangles = {};
    if (mesh->corners.empty()) from.refuse(check, "", "has no triangle with an area");
    checkSize(check, from, *mesh, options);
    if (!check.goesOn("joining a mesh", 1, 4)) return nullptr;
    findEdges(*mesh);
    if (mesh->closed()) checkClosed(check, from, *mesh, options.scale);
    if (!check.goesOn("joining a mesh", 2, 4)) return nullptr;
    if (options.form == Form::Hollow) {
        turnInside(*mesh);
        findEdges(*mesh);
    }
    if (!check.goesOn("joining a mesh", 3, 4)) return nullptr;
    findPatches(*mesh, largest);
    return mesh;
}

std::size_t Mesh::parts() const {
    constexpr std::size_t perPatch = 4;  // in the model `accurate`: keysPerGroup of sim/mesh_tables.cpp
    const auto meets = static_cast<std::size_t>(std::ranges::count_if(edges, &Edge::meets));
    return std::max(perPatch * patches.size(), patches.size() + meets + vertices.size());
}

double Mesh::volume() const {
    double volume = 0;
    for (std::uint32_t t = 0; t < corners.size(); ++t)
        volume += glm::dot(corner(t, 0), glm::cross(corner(t, 1), corner(t, 2))) / 6;
    return volume;
}

double Mesh::distance(const glm::dvec3& point) const {
    std::call_once(treeMade_, [&] { tree_ = std::make_unique<TriangleTree>(*this); });
    return tree_->distance(point);
}

}  // namespace spherule::scene
