#include "scene/archive.h"

#include <algorithm>
#include <utility>

#include "scene/check.h"
#include "scene/shapes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

// Returns true if all numbers of vertices, edges, triangles and patches are of some that exist.
bool isWhole(const Mesh& mesh) {
    const std::size_t vertices = mesh.vertices.size();
    const std::size_t triangles = mesh.corners.size();
    const auto allBelow = [](const auto& numbers, std::size_t count) {
        return std::ranges::all_of(numbers, [count](std::uint32_t number) { return number < count; });
    };
    return mesh.form <= Mesh::Form::Hollow && triangles > 0 && mesh.edgesOf.size() == triangles &&
           mesh.patchOf.size() == triangles && mesh.smoothOf.size() == mesh.patches.size() &&
           mesh.vertexNormals.size() == vertices && allBelow(mesh.patchOf, mesh.patches.size()) &&
           allBelow(mesh.smoothOf, mesh.patches.size()) &&
           std::ranges::all_of(mesh.corners, [&](const auto& three) { return allBelow(three, vertices); }) &&
           std::ranges::all_of(mesh.edgesOf,
                               [&](const auto& three) { return allBelow(three, 2 * mesh.edges.size()); }) &&
           std::ranges::all_of(mesh.edges, [&](const Mesh::Edge& edge) {
               return allBelow(edge.vertices, vertices) && edge.triangles[0] < triangles &&
                      (edge.triangles[1] < triangles || edge.triangles[1] == Mesh::none);
           });
}

}  // namespace

std::string bytesOf(const Shape& shape) {
    v1::Obstacle message;
    shape.write(message);
    Saver saver;
    saver(message.SerializeAsString(), shape.mesh());
    return saver.take();
}

ShapePointer shapeFrom(const std::string& bytes) {
    Loader loader(bytes);
    std::string text;
    std::shared_ptr<Mesh> mesh;
    loader(text, mesh);
    v1::Obstacle message;
    const bool meshed = message.ParseFromString(text) && (message.has_mesh() || message.has_height_field());
    if (!loader.ok() || loader.left() > 0 || meshed != (mesh != nullptr) || (mesh && !isWhole(*mesh))) return nullptr;
    Check check;
    ShapePointer shape = readShape(check, message, "obstacle", {.mesh = std::move(mesh)});
    return check.ok() ? shape : nullptr;
}

std::string bytesOf(const v1::Emitter& message) {
    return message.SerializeAsString();
}

std::shared_ptr<const v1::Emitter> emitterFrom(const std::string& bytes) {
    auto message = std::make_shared<v1::Emitter>();
    return message->ParseFromString(bytes) ? message : nullptr;
}

bool isWhole(const Scene& scene) {
    const std::size_t materials = scene.materials.size();
    const std::size_t groups = scene.groups.size();
    const auto fits = [&](const Sphere& sphere) {
        return sphere.material < materials && (groups == 0 || sphere.group < groups);
    };
    return materials > 0 && scene.bounds.material < materials && scene.step > 0 && scene.quality.substeps > 0 &&
           scene.quality.model <= Model::Accurate && std::ranges::all_of(scene.spheres, fits) &&
           std::ranges::all_of(scene.obstacles, [&](const Obstacle& one) { return one.material < materials; }) &&
           std::ranges::all_of(scene.groups, [&](const Group& one) { return one.material < materials; }) &&
           std::ranges::all_of(scene.pairs,
                               [&](const MaterialPair& one) { return one.a < materials && one.b < materials; }) &&
           std::ranges::all_of(scene.emitters, [&](const Emitter& one) {
               return one.material < materials && one.group < groups && !one.samples.empty() &&
                      std::ranges::all_of(one.samples, fits);
           });
}

}  // namespace spherule::scene
