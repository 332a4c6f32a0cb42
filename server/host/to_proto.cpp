#include "host/to_proto.h"

#include <algorithm>
#include <cstring>
#include <string>

#include <fmt/format.h>

#include "core/text.h"
#include "net/command_rules.h"
#include "scene/check.h"
#include "scene/mesh/mesh.h"
#include "scene/quality.h"
#include "scene/quality_goal.h"
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
    if (group.count == 0) return;
    const scene::Sphere& first = scene.spheres[group.first];
    message.set_material(first.material);
    message.set_fixed(first.fixed);
}

void setSpheres(v1::SceneFacts& facts, const scene::Scene& scene, bool radiiDiffer) {
    for (std::size_t k = 0; k < scene.groups.size(); ++k) {
        v1::GroupFacts& message = *facts.add_groups();
        setGroup(message, scene, k);
        message.set_first(scene.groups[k].first);
        message.set_count(scene.groups[k].count);
    }
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

namespace {

// The group of each sphere comes from its rank.
void addRun(google::protobuf::RepeatedPtrField<v1::Places>& to, std::uint32_t first, std::uint32_t count,
            std::uint64_t id, std::size_t group) {
    v1::Places& message = *to.Add();
    message.set_first(first);
    message.set_count(count);
    message.set_id(id);
    message.set_group(static_cast<std::uint32_t>(group));
}

// Adds runs of places, cut where the group changes. `runs` are in the order of the ids. Calls `each` with each message
// and the rank of its first sphere.
template <class Each>
void addRuns(google::protobuf::RepeatedPtrField<v1::Places>& to, const std::vector<encode::PlaceRun>& runs,
             const sim::Simulation& simulation, Each each) {
    const auto& groups = simulation.scene().groups;
    std::size_t group = 0;
    for (const encode::PlaceRun& run : runs) {
        for (std::uint32_t done = 0; done < run.count;) {
            const std::uint32_t rank = simulation.population().rankOf(run.id + done).value_or(0);
            // The last group that begins at the sphere or before it, and has spheres.
            while (group + 1 < groups.size() && rank >= groups[group].first + groups[group].count) ++group;
            const std::uint32_t end = groups.empty() ? rank + run.count : groups[group].first + groups[group].count;
            const std::uint32_t count = std::min(run.count - done, std::max(end, rank + 1) - rank);
            addRun(to, run.first + done, count, run.id + done, group);
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

v1::Welcome welcomeOf(const compute::DeviceInfo& device) {
    v1::Welcome welcome;
    welcome.set_server(std::string("spherule ") + SPHERULE_VERSION);
    welcome.set_device(device.kind);
    welcome.set_renderer(device.renderer);
    welcome.set_reason(device.reason);
    return welcome;
}

v1::ServerMessage settingsMessage(const scene::Scene& scene, double speed, bool paused) {
    v1::ServerMessage message;
    v1::Settings& settings = *message.mutable_settings();
    scene::setVector(*settings.mutable_gravity(), scene.forces.gravity);
    settings.set_restitution(scene.materials.front().restitution);
    settings.set_substeps(scene.quality.substeps);
    settings.set_speed(speed);
    settings.set_paused(paused);
    settings.set_step(scene.step);
    settings.set_model(scene::messageOf(scene.quality.model));
    settings.set_friction(scene.materials.front().friction);
    if (scene.quality.goal) *settings.mutable_auto_() = scene::messageOf(*scene.quality.goal);
    return message;
}

void setPoses(v1::Frame& frame, const std::vector<scene::Obstacle>& obstacles, double time) {
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
        if (!obstacles[k].motion || obstacles[k].motion->staysInPlace()) continue;
        const scene::Pose pose = obstacles[k].motion->poseAt(time);
        v1::Pose& message = *frame.add_poses();
        message.set_obstacle(static_cast<std::uint32_t>(k));
        scene::setVector(*message.mutable_translation(), pose.frame().origin);
        for (const double part : {pose.turn.x, pose.turn.y, pose.turn.z, pose.turn.w}) message.add_rotation(part);
    }
}

v1::Statistics statisticsMessage(const sim::Statistics& s) {
    v1::Statistics message;
    message.set_step(s.step);
    message.set_sim_time(s.time);
    message.set_spheres(s.spheres);
    message.set_born(s.born);
    message.set_removed(s.removed);
    message.set_kinetic_energy(s.kineticEnergy);
    message.set_rotational_energy(s.rotationalEnergy);
    message.set_elastic_energy(s.elasticEnergy);
    message.set_potential_energy(s.potentialEnergy);
    message.set_push_work(s.pushWork);
    scene::setVector(*message.mutable_momentum(), s.momentum);
    scene::setVector(*message.mutable_angular_momentum(), s.angularMomentum);
    message.set_contacts(s.contacts);
    message.set_overlap_mean(s.overlapMean);
    message.set_overlap_max(s.overlapMax);
    message.set_wall_overlap_max(s.wallOverlapMax);
    message.set_speed_max(s.speedMax);
    message.set_speed_rms(s.speedRms);
    message.set_mean_height(s.meanHeight);
    message.set_sleeping(s.sleeping);
    message.set_outside(s.outside);
    message.set_non_finite(s.nonFinite);
    if (s.impacts.count > 0) {
        message.set_impacts(static_cast<std::uint64_t>(s.impacts.count));
        message.set_restitution(s.impacts.restitution());
        message.set_restitution_asked(s.impacts.restitutionAsked());
    }
    if (s.contactSums) {
        message.set_collisions(static_cast<std::uint64_t>(s.contactSums->collisions));
        message.set_dissipated_energy(s.contactSums->dissipated);
        message.mutable_kinetic_stress()->Add(s.kineticStress.begin(), s.kineticStress.end());
    }
    for (const sim::SurfaceForce& on : s.surfaceForces) {
        v1::SurfaceForce& force = *message.add_surface_forces();
        force.set_surface(on.surface);
        scene::setVector(*force.mutable_force(), on.force);
        scene::setVector(*force.mutable_torque(), on.torque);
    }
    if (s.contactStress) message.mutable_contact_stress()->Add(s.contactStress->begin(), s.contactStress->end());
    if (s.stateHash) message.set_state_hash(fmt::format("{:016x}", *s.stateHash));
    return message;
}

namespace {

v1::Inspected inspectedMessage(const sim::Inspection& seen) {
    v1::Inspected message;
    message.set_sphere(seen.sphere);
    message.set_sim_time(seen.time);
    scene::setVector(*message.mutable_position(), seen.position);
    scene::setVector(*message.mutable_velocity(), seen.velocity);
    scene::setVector(*message.mutable_spin(), seen.spin);
    if (seen.mass) message.set_mass(*seen.mass);
    message.set_radius(seen.radius);
    message.set_material(utf8(seen.material));
    message.set_contact_count(seen.touches);
    for (const sim::TouchedBody& touched : seen.contacts) {
        v1::Contact& contact = *message.add_contacts();
        if (const auto* const sphere = std::get_if<std::uint64_t>(&touched.body))
            contact.set_sphere(*sphere);
        else
            contact.set_surface(std::get<std::string>(touched.body));
        contact.set_overlap(touched.overlap);
    }
    return message;
}

v1::Applied appliedMessage(const sim::Applied& applied) {
    v1::Applied message;
    message.set_step(applied.step);
    if (applied.sphere) message.set_sphere(*applied.sphere);
    if (applied.removed) message.set_removed(*applied.removed);
    if (applied.obstacle) message.set_obstacle(*applied.obstacle);
    if (applied.force) scene::setVector(*message.mutable_force(), *applied.force);
    if (applied.statistics) *message.mutable_statistics() = statisticsMessage(*applied.statistics);
    if (applied.inspected) *message.mutable_inspected() = inspectedMessage(*applied.inspected);
    return message;
}

// The path from the Command to the field that `where` begins with; empty if the command's message has no such field.
std::string fieldOf(const v1::Command& command, std::string_view where) {
    const auto& kinds = *v1::Command::descriptor()->oneof_decl(0);
    const auto* const kind = command.GetReflection()->GetOneofFieldDescriptor(command, &kinds);
    const std::string_view root = where.substr(0, where.find_first_of(".["));
    for (int k = 0; kind != nullptr && k < kind->message_type()->field_count(); ++k)
        if (kind->message_type()->field(k)->json_name() == root)
            return std::string(kind->json_name()).append(".").append(where);
    return "";
}

}  // namespace

static_assert(static_cast<int>(Cause::Stopping) == v1::Refused::STOPPING &&
              v1::Refused::Cause_MAX == v1::Refused::STOPPING);

v1::CommandResult resultOf(const v1::Command& command, const Result<sim::Applied>& applied) {
    v1::CommandResult result;
    result.set_id(command.id());
    if (applied) {
        *result.mutable_applied() = appliedMessage(*applied);
    } else {
        std::string field = fieldOf(command, applied.error().where);
        result.mutable_refused()->set_reason(utf8(field.empty() ? applied.error().text() : applied.error().message));
        result.mutable_refused()->set_field(std::move(field));
        result.mutable_refused()->set_cause(static_cast<v1::Refused::Cause>(applied.error().cause));
        if (const auto least = applied.error().limits.least) result.mutable_refused()->set_least(*least);
        if (const auto most = applied.error().limits.most) result.mutable_refused()->set_most(*most);
    }
    return result;
}

v1::Event eventOf(const v1::Command& command, const sim::Applied& applied, std::uint64_t spheres) {
    v1::Event event;
    event.set_kind(v1::Event::COMMANDED);
    event.set_text(wordsFor(command));
    event.set_step(applied.step);
    event.set_spheres(spheres);
    v1::Command& told = *event.mutable_command();
    // Spheres and scenes in commands may take megabytes.
    if (command.has_spawn())
        told.mutable_spawn()->mutable_group()->set_name(command.spawn().group().name());
    else if (command.has_remove())
        told.mutable_remove();
    else if (command.has_add_obstacle())
        told.mutable_add_obstacle();
    else if (command.has_load())
        told.mutable_load()->set_name(
            utf8(command.load().has_scene() ? command.load().scene().name() : command.load().name()));
    else
        told = command;
    told.clear_id();
    return event;
}

std::string wordsFor(const v1::Command& command) {
    const std::string& name = net::nameOf(command);
    if (!command.has_load()) return name;
    const v1::LoadScene& load = command.load();
    return name + " " + utf8(load.has_scene() ? load.scene().name() : load.name());
}

}  // namespace spherule::host
