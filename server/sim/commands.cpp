#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "scene/goal.h"
#include "scene/load.h"
#include "scene/materials.h"
#include "scene/quality.h"
#include "sim/need.h"
#include "sim/parameters.h"
#include "sim/picking.h"
#include "sim/simulation.h"

namespace spherule::sim {

namespace {

constexpr double mostGravity = 1e6;  // m/s^2
constexpr double farthest = 1e9;     // m

tl::unexpected<Error> refusal(const Error& error) {
    // By the command's name for it.
    constexpr std::string_view prefix = "quality.";
    const bool quality = error.where.starts_with(prefix);
    return fail(ErrorKind::Refused, quality ? error.where.substr(prefix.size()) : error.where, error.message);
}

Result<void> setGravity(scene::Scene& scene, const v1::Set& set) {
    if (set.gravity().empty()) return {};
    auto gravity = scene::vectorOf(set.gravity(), "gravity");
    if (!gravity) return tl::unexpected(gravity.error());
    if (!(glm::length(*gravity) <= mostGravity))
        return fail(ErrorKind::Refused, "gravity",
                    fmt::format("is {:g} m/s^2 long, at most {:g} is allowed", glm::length(*gravity), mostGravity));
    scene.gravity = *gravity;
    return {};
}

// Sets a property of all materials, and ends what pairs have of their own.
Result<void> setMaterials(scene::Scene& scene, double value, double most, const char* name,
                          double scene::Material::*ofMaterial, std::optional<double> scene::MaterialPair::*ofPair) {
    if (!(value >= 0 && value <= most))
        return fail(ErrorKind::Refused, name, fmt::format("is {:g}, must be within 0 and {:g}", value, most));
    for (scene::Material& material : scene.materials) material.*ofMaterial = value;
    for (scene::MaterialPair& pair : scene.pairs) (pair.*ofPair).reset();
    return {};
}

Result<void> setRestitution(scene::Scene& scene, const v1::Set& set) {
    if (!set.has_restitution()) return {};
    return setMaterials(scene, set.restitution(), 1, "restitution", &scene::Material::restitution,
                        &scene::MaterialPair::restitution);
}

Result<void> setFriction(scene::Scene& scene, const v1::Set& set) {
    if (!set.has_friction()) return {};
    return setMaterials(scene, set.friction(), scene::largestFriction, "friction", &scene::Material::friction,
                        &scene::MaterialPair::friction);
}

// With the substeps that suit the new model, unless the command has its own.
Result<void> setModel(scene::Scene& scene, const v1::Set& set) {
    if (!set.has_model()) return {};
    if (set.model() <= v1::MODEL_UNSPECIFIED || set.model() > v1::ACCURATE)
        return fail(ErrorKind::Refused, "model",
                    fmt::format("is {}, must be FAST, BALANCED or ACCURATE", static_cast<int>(set.model())));
    scene.quality.model = scene::modelOf(set.model());
    scene.quality.pinned = false;
    scene.quality.goal.reset();
    if (auto fits = scene::checkModel(scene); !fits) return refusal(fits.error());
    return {};
}

Result<void> setSubsteps(scene::Scene& scene, const v1::Set& set) {
    if (!set.has_substeps()) return {};
    scene.quality.pinned = true;
    scene.quality.substeps = set.substeps();
    scene.quality.goal.reset();
    return {};
}

Result<void> setGoal(scene::Scene& scene, const v1::Set& set) {
    if (!set.has_auto_()) return {};
    auto goal = scene::goalOf(set.auto_(), "auto");
    if (!goal) return refusal(goal.error());
    scene.quality.goal = *goal;
    return {};
}

}  // namespace

Result<v1::Applied> Simulation::apply(const v1::Command& command) {
    v1::Applied applied;
    Result<void> done;
    switch (command.kind_case()) {
        case v1::Command::kSet:
            done = set(command.set());
            break;
        case v1::Command::kSpawn:
            done = spawn(command.spawn());
            break;
        case v1::Command::kPush: {
            auto hit = push(command.push());
            if (!hit) return tl::unexpected(hit.error());
            applied.set_sphere(*hit);
            break;
        }
        case v1::Command::kReset:
            done = reset();
            break;
        case v1::Command::kQuery:
            *applied.mutable_statistics() = message(statistics());
            break;
        default:
            return fail(ErrorKind::Refused, "", "this command is not one for a simulation");
    }
    if (!done) return tl::unexpected(done.error());
    applied.set_step(steps_);
    return applied;
}

Result<void> Simulation::set(const v1::Set& set) {
    const bool disturbs = !set.gravity().empty() || set.has_restitution() || set.has_friction() || set.has_model();
    if (!disturbs && !set.has_substeps() && !set.has_auto_()) return {};
    scene::Scene changed = scene_;
    for (auto part : {setGravity, setRestitution, setFriction, setModel, setSubsteps, setGoal})
        if (auto done = part(changed, set); !done) return done;
    return change(std::move(changed), disturbs);
}

Result<void> Simulation::chooseSubsteps(std::uint32_t substeps) {
    scene::Scene changed = scene_;
    changed.quality.pinned = true;
    changed.quality.substeps = substeps;
    return change(std::move(changed), false);
}

Result<void> Simulation::change(scene::Scene changed, bool disturbs) {
    // Gravity and the model have a say in how short a substep must be.
    if (auto fits = scene::fitSubsteps(changed); !fits) return refusal(fits.error());
    scene::Features features = scene::featuresOf(changed);
    features.levels = plan().features.levels;  // a matter of the spheres alone
    if (features == plan().features) {
        scene_ = std::move(changed);
        substeps_ = scene_.quality.substeps;
        uploadConstants();
        // A change of substeps alone disturbs nobody's sleep.
        if (disturbs) pipeline_->wakeAll();
    } else {
        auto copies = memory::Claim::make("", "a change of the scene", copiesToChange(plan()));
        if (!copies) return tl::unexpected(copies.error());
        auto state = liveState();
        if (!state) return tl::unexpected(state.error());
        if (auto done = adopt(std::move(changed), std::move(*state)); !done) return done;
    }
    return {};
}

Result<void> Simulation::spawn(const v1::Spawn& spawn) {
    auto copies = memory::Claim::make("group", "adding spheres to those that there are", copiesToSpawn(plan()));
    if (!copies) return tl::unexpected(copies.error());
    auto live = liveState();
    if (!live) return tl::unexpected(live.error());
    State& state = *live;
    scene::Scene grown = scene_;
    const glm::dvec3 centre = grown.bounds.centre();
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        const glm::dvec3 now = glm::dvec3(state.position[id]);
        // One that has left the numbers, or the world, counts where it began.
        if (glm::dot(now, now) < farthest * farthest) grown.spheres[id].position = now + centre;
    }

    auto added = scene::buildGroup(spawn.group(), grown);
    if (!added) return tl::unexpected(added.error());
    if (added->empty()) return fail(ErrorKind::Refused, "group", "has no spheres");
    grown.groups.push_back(
        {spawn.group().name(), state.count(), static_cast<std::uint32_t>(added->size()), spawn.group().colour()});
    scene::Scene addition = scene_;
    addition.spheres = *added;
    const State fresh = stateOf(addition);
    state.position.insert(state.position.end(), fresh.position.begin(), fresh.position.end());
    state.velocity.insert(state.velocity.end(), fresh.velocity.begin(), fresh.velocity.end());
    state.spin.insert(state.spin.end(), fresh.spin.begin(), fresh.spin.end());
    grown.spheres.insert(grown.spheres.end(), added->begin(), added->end());
    if (auto fits = scene::fitSubsteps(grown); !fits) return refusal(fits.error());
    if (auto done = adopt(std::move(grown), std::move(state)); !done) return done;
    impacts_ = {};
    ++generation_;
    return {};
}

Result<std::uint32_t> Simulation::push(const v1::Push& push) {
    auto impulse = scene::vectorOf(push.impulse(), "impulse");
    if (!impulse) return tl::unexpected(impulse.error());
    std::uint32_t id = push.sphere();
    if (push.has_ray()) {
        auto origin = scene::vectorOf(push.ray().origin(), "ray.origin");
        auto direction = scene::vectorOf(push.ray().direction(), "ray.direction");
        if (!origin) return tl::unexpected(origin.error());
        if (!direction) return tl::unexpected(direction.error());
        const double length = glm::length(*direction);
        if (!(length > 0)) return fail(ErrorKind::Refused, "ray.direction", "has no length");
        const auto hit = firstHit(snapshot(), *origin - scene_.bounds.centre(), *direction / length);
        if (!hit) return fail(ErrorKind::Refused, "ray", "meets no sphere");
        id = *hit;
    } else if (push.target_case() != v1::Push::kSphere) {
        return fail(ErrorKind::Refused, "target", "is missing: give a sphere or a ray");
    }
    if (id >= count())
        return fail(ErrorKind::Refused, "sphere", fmt::format("is {}, the scene has {} spheres", id, count()));
    pipeline_->kick(id, glm::vec3(*impulse));
    const double speed = glm::length(glm::dvec3(pipeline_->velocityOf(id)));
    if (const double moved = speed * scene_.step / substeps_ / static_cast<double>(scene_.spheres[id].radius);
        moved > static_cast<double>(FAR_MOTION))
        fitToMotion(moved);
    return id;
}

v1::Statistics Simulation::message(const Statistics& s) const {
    v1::Statistics message;
    message.set_step(steps_);
    message.set_sim_time(time_);
    message.set_spheres(count());
    message.set_kinetic_energy(s.kineticEnergy);
    message.set_rotational_energy(s.rotationalEnergy);
    message.set_potential_energy(s.potentialEnergy);
    message.set_push_work(s.pushWork);
    for (int axis = 0; axis < 3; ++axis) message.add_momentum(s.momentum[axis]);
    for (int axis = 0; axis < 3; ++axis) message.add_angular_momentum(s.angularMomentum[axis]);
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
    return message;
}

}  // namespace spherule::sim
