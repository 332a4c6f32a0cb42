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

namespace {

void setFlow(v1::FlowCounts& message, const sim::FlowCounts& flow) {
    message.set_spheres(flow.spheres);
    message.set_mass(flow.mass);
    message.set_spheres_per_second(flow.spheresPerSecond);
    message.set_mass_per_second(flow.massPerSecond);
}

void setFlows(v1::Statistics& message, const sim::Statistics& s) {
    for (const sim::EmitterCounts& emitter : s.emitters) {
        v1::EmitterCounts& to = *message.add_emitters();
        to.set_name(emitter.name);
        setFlow(*to.mutable_born(), emitter.born);
        to.set_blocked(emitter.blocked);
        to.set_waiting(emitter.waiting);
        to.set_ended(emitter.ended);
    }
    for (const sim::SinkCounts& sink : s.sinks) {
        v1::SinkCounts& to = *message.add_sinks();
        setFlow(*to.mutable_taken(), sink.taken);
        for (const std::uint64_t spheres : sink.byMaterial) to.add_by_material(spheres);
    }
}

}  // namespace

v1::Statistics statisticsMessage(const sim::Statistics& s) {
    v1::Statistics message;
    message.set_step(s.step);
    message.set_sim_time(s.time);
    message.set_spheres(s.spheres);
    message.set_born(s.born);
    message.set_removed(s.removed);
    setFlows(message, s);
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
    if (applied.number) message.set_number(*applied.number);
    if (!applied.file.empty()) message.set_file(utf8(applied.file));
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

static_assert(static_cast<int>(Cause::NoCheckpoints) == v1::Refused::NO_CHECKPOINTS &&
              v1::Refused::Cause_MAX == v1::Refused::NO_CHECKPOINTS);

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
    else if (command.has_add_emitter())
        told.mutable_add_emitter()->mutable_emitter()->set_name(command.add_emitter().emitter().name());
    else if (command.has_change_emitter())
        told.mutable_change_emitter()->mutable_emitter()->set_name(command.change_emitter().emitter().name());
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
