#include <filesystem>
#include <utility>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>
#include <glm/geometric.hpp>

#include "scene/check.h"
#include "scene/mesh/mesh.h"
#include "scene/mesh/triangles.h"
#include "scene/shapes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

// The triangles as OBJ, in the coordinates of the obstacle.
std::string objText(const Mesh& mesh) {
    std::string text;
    for (const glm::dvec3& vertex : mesh.vertices) {
        const glm::dvec3 place = vertex + mesh.centre;
        text += fmt::format("v {} {} {}\n", place.x, place.y, place.z);
    }
    const bool turned = mesh.form == Mesh::Form::Hollow;
    for (const auto& corners : mesh.corners)
        text += fmt::format("f {} {} {}\n", corners[0] + 1, corners[turned ? 2 : 1] + 1, corners[turned ? 1 : 2] + 1);
    return text;
}

// A mesh with the message that gives it: the bytes of a short file, or the path of a long one.
class MeshShape final : public Shape {
  public:
    MeshShape(std::shared_ptr<const Mesh> mesh, v1::Obstacle message)
        : mesh_(std::move(mesh)), message_(std::move(message)) {}

    [[nodiscard]] ShapeKind kind() const override { return ShapeKind::Meshes; }
    [[nodiscard]] double distance(const glm::dvec3& point) const override {
        return mesh_->distance(point - mesh_->centre);
    }
    [[nodiscard]] double farthest(const glm::dvec3& from) const override {
        return glm::distance(mesh_->centre, from) + glm::length(mesh_->half);
    }
    [[nodiscard]] std::shared_ptr<const Mesh> mesh() const override { return mesh_; }
    // The kernels' numbers of the mesh follow from its grid: see sim/mesh_tables.h.
    [[nodiscard]] Row row(const glm::dvec3& origin) const override {
        return {.frame = Frame{glm::dmat3(1), mesh_->centre - origin}};
    }
    void write(v1::Obstacle& message) const override {
        if (message_.has_height_field()) {
            *message.mutable_height_field() = message_.height_field();
            return;
        }
        *message.mutable_mesh() = message_.mesh();
        if (message_.mesh().file().empty() && message_.mesh().data().empty())
            message.mutable_mesh()->set_data(objText(*mesh_));
    }

  private:
    std::shared_ptr<const Mesh> mesh_;
    v1::Obstacle message_;
};

// A closed box with outward normals.
Triangles boxTriangles(const glm::dvec3& low, const glm::dvec3& high) {
    Triangles box;
    for (int k = 0; k < 8; ++k)
        box.vertices.emplace_back((k & 1) != 0 ? high.x : low.x, (k & 2) != 0 ? high.y : low.y,
                                  (k & 4) != 0 ? high.z : low.z);
    box.corners = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return box;
}

// Refuses a mesh that names no file and has no data, or both.
std::optional<std::string> bytesOf(Check& check, v1::Mesh& mesh, const std::string& here, const ShapeInput& input) {
    if (!mesh.file().empty() && !mesh.data().empty()) {
        check.refuse(at(here, "data"), "is given with `file`; leave one of them out");
        return std::nullopt;
    }
    if (mesh.file().empty() && mesh.data().empty()) {
        check.refuse(at(here, "file"), "is missing; name an STL or OBJ file, or give its bytes as `data`");
        return std::nullopt;
    }
    if (mesh.data().size() > longestInlineMesh) {
        check.refuse(at(here, "data"), fmt::format("has {} bytes, must have at most {}; name a file in place of it",
                                                   mesh.data().size(), longestInlineMesh));
        return std::nullopt;
    }
    if (mesh.file().empty()) return mesh.data();
    auto bytes = readMeshFile(check, input.directory, mesh.file(), at(here, "file"));
    if (!bytes) return std::nullopt;
    mesh.set_file(std::filesystem::absolute(*input.directory / mesh.file()).lexically_normal().string());
    return bytes;
}

}  // namespace

ShapePointer readMesh(Check& check, const v1::Mesh& message, const std::string& here, const ShapeInput& input) {
    v1::Obstacle kept;
    v1::Mesh& mesh = *kept.mutable_mesh();
    mesh = message;
    if (input.mesh) return meshShape(input.mesh, kept);
    double scale = 1;
    if (mesh.scale() != 0) scale = check.upTo(mesh.scale(), 1e9, at(here, "scale"), " m per unit");
    check.part([&] {
        if (mesh.solid() && mesh.hollow())
            check.refuse(at(here, "hollow"), "is true with `solid`; leave one of them out");
    });
    const auto bytes = bytesOf(check, mesh, here, input);
    if (!bytes || !check.ok()) return nullptr;
    const MeshBytes from{at(here, mesh.file().empty() ? "data" : "file"), mesh.file(), *bytes};
    Triangles triangles = readTriangles(check, from);
    if (!mesh.file().empty() && bytes->size() <= longestInlineMesh) {
        mesh.set_data(*bytes);
        mesh.clear_file();
    }
    const Mesh::Form form = mesh.hollow() ? Mesh::Form::Hollow : (mesh.solid() ? Mesh::Form::Solid : Mesh::Form::Sheet);
    const auto made =
        Mesh::make(check, from, std::move(triangles), {.scale = scale, .form = form, .longestSide = input.longestSide});
    if (!made) return nullptr;
    if (const std::string notes = made->report.text(); !notes.empty())
        spdlog::info("{}{}: {}", from.field, from.name.empty() ? "" : fmt::format(" ({})", from.name), notes);
    return meshShape(made, kept);
}

ShapePointer meshShape(std::shared_ptr<const Mesh> mesh, const v1::Obstacle& message) {
    return std::make_shared<MeshShape>(std::move(mesh), message);
}

ShapePointer meshShape(Triangles triangles, Mesh::Form form) {
    Check check;
    const auto mesh = Mesh::make(check, {"mesh", "", {}}, std::move(triangles), {.form = form});
    v1::Obstacle message;
    message.mutable_mesh()->set_solid(form == Mesh::Form::Solid);
    message.mutable_mesh()->set_hollow(form == Mesh::Form::Hollow);
    return mesh ? meshShape(mesh, message) : nullptr;
}

const ShapeType shapesMeshes{
    .field = v1::Obstacle::kMesh,
    .read = [](Check& check, const v1::Obstacle& message, const std::string& field,
               const ShapeInput& input) { return readMesh(check, message.mesh(), at(field, "mesh"), input); },
    .example =
        [](double top) {
            return meshShape(boxTriangles({0, 0, top - 1}, {1, 1, top}), Mesh::Form::Solid);
        },
};

}  // namespace spherule::scene
