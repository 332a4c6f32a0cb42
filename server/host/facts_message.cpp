#include "host/facts_message.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "scene/check.h"
#include "scene/describe.h"
#include "scene/mesh/mesh.h"
#include "scene/surroundings.h"
#include "scene/view.h"

namespace spherule::host {

namespace {

constexpr std::size_t mostMeshBytes = 4U << 20U;  // of all meshes in a message

// Adds the triangles, without those that would make the message too long.
void setMesh(v1::SceneFacts& facts, v1::Obstacle& obstacle, const scene::Mesh& mesh) {
    obstacle.mutable_mesh()->set_solid(mesh.form == scene::Mesh::Form::Solid);
    obstacle.mutable_mesh()->set_hollow(mesh.form == scene::Mesh::Form::Hollow);
    std::size_t sent = 0;
    for (const v1::MeshFacts& other : facts.meshes()) sent += other.vertices().size() + other.indices().size();
    v1::MeshFacts& message = *facts.add_meshes();
    message.set_obstacle(static_cast<std::uint32_t>(facts.obstacles_size() - 1));
    scene::setVector(*message.mutable_min(), mesh.centre - mesh.half);
    scene::setVector(*message.mutable_max(), mesh.centre + mesh.half);
    message.set_triangles(static_cast<std::uint32_t>(mesh.corners.size()));
    const std::size_t bytes = mesh.vertices.size() * sizeof(glm::vec3) + mesh.corners.size() * sizeof(mesh.corners[0]);
    if (sent + bytes > mostMeshBytes) return;
    std::vector<glm::vec3> vertices;
    for (const glm::dvec3& vertex : mesh.vertices) vertices.emplace_back(vertex + mesh.centre);
    message.set_vertices(vertices.data(), vertices.size() * sizeof(glm::vec3));
    message.set_indices(mesh.corners.data(), mesh.corners.size() * sizeof(mesh.corners[0]));
}

void setObstacles(v1::SceneFacts& facts, const scene::Scene& scene) {
    for (const scene::Obstacle& obstacle : scene.obstacles) {
        v1::Obstacle& message = *facts.add_obstacles();
        const auto mesh = obstacle.shape->mesh();
        if (!mesh) {
            scene::writeObstacle(message, obstacle);
            continue;
        }
        // Its message may name a file of this machine.
        obstacle.shape->writePlace(message);
        message.set_colour(obstacle.colour);
        if (obstacle.motion) scene::writeMotion(*message.mutable_motion(), *obstacle.motion);
        setMesh(facts, message, *mesh);
    }
}

void setGroup(v1::GroupFacts& message, const scene::Scene& scene, std::size_t number) {
    const scene::Group& group = scene.groups[number];
    message.set_name(group.name);
    message.set_colour(group.look.colour);
    message.set_roughness(static_cast<float>(group.look.roughness));
    message.set_metal(static_cast<float>(group.look.metal));
    message.set_material(group.material);
    message.set_fixed(group.fixed);
}

void addRun(google::protobuf::RepeatedPtrField<v1::Places>& to, std::uint32_t first, std::uint32_t count,
            std::uint64_t id, std::uint32_t group) {
    v1::Places& message = *to.Add();
    message.set_first(first);
    message.set_count(count);
    message.set_id(id);
    message.set_group(group);
}

// Returns the end of the spheres of one group that begin with the one of rank `begin`, at most `end`.
std::uint32_t endOfRun(const std::vector<scene::Sphere>& spheres, std::uint32_t begin, std::uint32_t end) {
    std::uint32_t rank = begin + 1;
    while (rank < end && spheres[rank].group == spheres[begin].group) ++rank;
    return rank;
}

// Tells which spheres are of which group: by the groups themselves, or by places if the spheres of one are not all
// behind one another.
void setGroups(v1::SceneFacts& facts, const scene::Scene& scene) {
    for (std::size_t k = 0; k < scene.groups.size(); ++k) {
        setGroup(*facts.add_groups(), scene, k);
        facts.mutable_groups(static_cast<int>(k))->set_count(scene.groups[k].count);
    }
    const auto spheres = static_cast<std::uint32_t>(scene.spheres.size());
    bool together = true;
    for (std::uint32_t first = 0, end = 0; first < spheres && !scene.groups.empty(); first = end) {
        end = endOfRun(scene.spheres, first, spheres);
        const std::uint16_t group = scene.spheres[first].group;
        together = together && end - first == scene.groups[group].count;
        facts.mutable_groups(group)->set_first(first);
        addRun(*facts.mutable_places(), first, end - first, first, group);
    }
    if (together) facts.clear_places();
}

void setSpheres(v1::SceneFacts& facts, const scene::Scene& scene, bool radiiDiffer) {
    setGroups(facts, scene);
    facts.set_count(static_cast<std::uint32_t>(scene.spheres.size()));
    if (!radiiDiffer) {
        facts.set_radius(scene.spheres.empty() ? 0.0F : scene.spheres.front().radius);
        return;
    }
    std::string radii(scene.spheres.size() * sizeof(float), '\0');
    for (std::size_t id = 0; id < scene.spheres.size(); ++id)
        std::memcpy(&radii[id * sizeof(float)], &scene.spheres[id].radius, sizeof(float));
    facts.set_radii(std::move(radii));
}

}  // namespace

v1::ServerMessage factsMessage(const sim::Simulation& simulation, std::uint32_t epoch) {
    const scene::Scene& scene = simulation.scene();
    const sim::Plan& plan = simulation.plan();
    v1::ServerMessage message;
    v1::SceneFacts& facts = *message.mutable_scene();
    facts.set_epoch(epoch);
    facts.set_name(scene.name);
    facts.set_description(scene.description);
    facts.set_what_to_try(scene.whatToTry);
    scene::setVector(*facts.mutable_bounds_min(), scene.bounds.min);
    scene::setVector(*facts.mutable_bounds_max(), scene.bounds.max);
    for (int face = 0; face < 6; ++face)
        if (scene.bounds.open[static_cast<std::size_t>(face)]) facts.add_open(static_cast<v1::Face>(face + v1::X_MIN));
    for (int axis = 0; axis < 3; ++axis)
        if (scene.bounds.periodic[static_cast<std::size_t>(axis)])
            facts.add_periodic(static_cast<v1::Axis>(axis + v1::X));
    setObstacles(facts, scene);
    for (const scene::Material& material : scene.materials) facts.add_materials(material.name);
    setSpheres(facts, scene, plan.features.has(sim::Feature::Radii));
    scene::setVector(*facts.mutable_camera()->mutable_eye(), scene.camera.eye);
    scene::setVector(*facts.mutable_camera()->mutable_target(), scene.camera.target);
    facts.mutable_camera()->set_field_of_view(scene.camera.fieldOfView);
    if (scene.light) *facts.mutable_light() = scene::messageOf(*scene.light);
    facts.set_cell_size(static_cast<double>(plan.grid.coarsest().cellSize));
    if (plan.features.has(sim::Feature::Contacts))
        for (int axis = 0; axis < 3; ++axis) facts.add_cells(plan.grid.coarsest().cells[axis]);
    return message;
}

v1::ServerMessage partsMessage(const scene::Scene& scene) {
    v1::ServerMessage message;
    v1::SceneParts& parts = *message.mutable_parts();
    scene::writeFields(*parts.mutable_fields(), scene.forces.fields);
    for (const scene::Emitter& emitter : scene.emitters) *parts.add_emitters() = *emitter.message;
    scene::writeMaterials(scene, *parts.mutable_materials(), *parts.mutable_pairs());
    return message;
}

namespace {

// Adds runs of places, cut where the group changes. `runs` are in the order of the ids. Calls `each` with each message
// and the rank of its first sphere.
template <class Each>
void addRuns(google::protobuf::RepeatedPtrField<v1::Places>& to, const std::vector<encode::PlaceRun>& runs,
             const sim::Simulation& simulation, Each each) {
    const std::vector<scene::Sphere>& spheres = simulation.scene().spheres;
    for (const encode::PlaceRun& run : runs) {
        for (std::uint32_t done = 0; done < run.count;) {
            const std::uint32_t rank = simulation.population().rankOf(run.id + done).value_or(0);
            const std::uint32_t count = endOfRun(spheres, rank, rank + run.count - done) - rank;
            addRun(to, run.first + done, count, run.id + done, spheres[rank].group);
            each(to[to.size() - 1], rank);
            done += count;
        }
    }
}

}  // namespace

v1::ServerMessage factsMessage(const sim::Simulation& simulation, std::uint32_t epoch, const encode::Places& places,
                               std::uint32_t population) {
    v1::ServerMessage message = factsMessage(simulation, epoch);
    v1::SceneFacts& facts = *message.mutable_scene();
    const std::vector<scene::Sphere>& spheres = simulation.scene().spheres;
    const bool radiiDiffer = simulation.plan().features.has(sim::Feature::Radii);
    if (!radiiDiffer) facts.set_radius(static_cast<float>(simulation.radii().largest));
    facts.set_count(places.count());
    facts.set_population(population);
    std::string radii(radiiDiffer ? places.count() * sizeof(float) : 0, '\0');
    addRuns(*facts.mutable_places(), places.inUse(), simulation, [&](const v1::Places& run, std::uint32_t rank) {
        for (std::uint32_t k = 0; radiiDiffer && k < run.count(); ++k)
            std::memcpy(&radii[(run.first() + k) * sizeof(float)], &spheres[rank + k].radius, sizeof(float));
    });
    facts.set_radii(std::move(radii));
    if (facts.places().empty()) facts.add_places();  // no run would say that all places are in use
    return message;
}

v1::ServerMessage populationMessage(const sim::Simulation& simulation, const encode::Places::Change& change,
                                    std::size_t groupsBefore) {
    v1::ServerMessage message;
    v1::Population& population = *message.mutable_population();
    const scene::Scene& scene = simulation.scene();
    for (const encode::PlaceRun& run : change.removed) {
        v1::Places& places = *population.add_removed();
        places.set_first(run.first);
        places.set_count(run.count);
    }
    const bool radiiDiffer = simulation.plan().features.has(sim::Feature::Radii);
    addRuns(*population.mutable_added(), change.added, simulation, [&](v1::Places& run, std::uint32_t rank) {
        if (!radiiDiffer) return;
        std::string radii(run.count() * sizeof(float), '\0');
        for (std::uint32_t k = 0; k < run.count(); ++k)
            std::memcpy(&radii[k * sizeof(float)], &scene.spheres[rank + k].radius, sizeof(float));
        run.set_radii(std::move(radii));
    });
    for (std::size_t k = groupsBefore; k < scene.groups.size(); ++k) setGroup(*population.add_groups(), scene, k);
    population.set_step(simulation.steps());
    return message;
}

}  // namespace spherule::host
