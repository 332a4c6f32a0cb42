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
    auto outcome = begin(command);
    if (!outcome) return tl::unexpected(outcome.error());
    if (!outcome->preparation) return std::move(outcome->applied);
    if (auto done = outcome->preparation->finish(); !done) return tl::unexpected(done.error());
    return adopt(std::move(outcome->preparation));
}

Result<Simulation::Outcome> Simulation::begin(const v1::Command& command) {
    Result<Outcome> outcome;
    switch (command.kind_case()) {
        case v1::Command::kSet:
            outcome = set(command.set());
            break;
        case v1::Command::kSpawn:
            outcome = spawn(command.spawn());
            break;
        case v1::Command::kPush: {
            auto hit = push(command.push());
            if (!hit) return tl::unexpected(hit.error());
            outcome->applied.set_sphere(*hit);
            break;
        }
        case v1::Command::kReset:
            outcome = reset();
            break;
        case v1::Command::kQuery:
            *outcome->applied.mutable_statistics() = message(statistics());
            break;
        default:
            return fail(ErrorKind::Refused, "", "this command is not one for a simulation");
    }
    if (outcome) outcome->applied.set_step(steps_);
    return outcome;
}

Result<Simulation::Outcome> Simulation::set(const v1::Set& set) {
    const bool disturbs = !set.gravity().empty() || set.has_restitution() || set.has_friction() || set.has_model();
    if (!disturbs && !set.has_substeps() && !set.has_auto_()) return {};
    scene::Scene changed = scene_;
    for (auto part : {setGravity, setRestitution, setFriction, setModel, setSubsteps, setGoal})
        if (auto done = part(changed, set); !done) return tl::unexpected(done.error());
    return change(std::move(changed), disturbs);
}

// The same features at any number of substeps: nothing is to be prepared.
Result<void> Simulation::chooseSubsteps(std::uint32_t substeps) {
    scene::Scene changed = scene_;
    changed.quality.pinned = true;
    changed.quality.substeps = substeps;
    auto outcome = change(std::move(changed), false);
    if (!outcome) return tl::unexpected(outcome.error());
    return {};
}

Result<Simulation::Outcome> Simulation::change(scene::Scene changed, bool disturbs) {
    // Gravity and the model have a say in how short a substep must be.
    if (auto fits = scene::fitSubsteps(changed); !fits) return refusal(fits.error());
    Features features = featuresOf(changed);
    features.set(Feature::Levels, plan().features.has(Feature::Levels));  // a matter of the spheres alone
    if (features == plan().features) {
        scene_ = std::move(changed);
        mostSubsteps_ = scene::mostRaised(scene_);
        writeConstants(*pipeline_, scene_);
        useSubsteps(scene_.quality.substeps);
        // A change of substeps alone disturbs nobody's sleep.
        if (disturbs) pipeline_->wakeAll();
        return {};
    }
    auto copies = memory::Claim::make("", "a change of the scene", copiesToChange(plan()));
    if (!copies) return tl::unexpected(copies.error());
    auto state = liveState();
    if (!state) return tl::unexpected(state.error());
    return prepare(Anew::Nothing, std::move(*copies), Built{std::move(changed), std::move(*state)});
}

Result<Simulation::Outcome> Simulation::reset() {
    auto copies = memory::Claim::make("", "the scene as it began", copiesToChange(plan()));
    if (!copies) return tl::unexpected(copies.error());
    return prepare(Anew::World, std::move(*copies), Built{initial_, stateOf(initial_)});
}

namespace {

// The scene as it is, with the group's spheres, and all spheres' states: those of the old ones are `state`.
Result<Built> grownBy(const v1::Group& group, scene::Scene scene, State state, Progress& progress) {
    const glm::dvec3 centre = scene.bounds.centre();
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        const glm::dvec3 now = glm::dvec3(state.position[id]);
        // One that has left the numbers, or the world, counts where it began.
        if (glm::dot(now, now) < farthest * farthest) scene.spheres[id].position = now + centre;
    }
    auto added = scene::buildGroup(group, scene, &progress);
    if (!added) return tl::unexpected(added.error());
    if (added->empty()) return fail(ErrorKind::Refused, "group", "has no spheres");
    scene.groups.push_back({group.name(), state.count(), static_cast<std::uint32_t>(added->size()), group.colour()});
    const State fresh = stateOf(scene, *added);
    state.position.insert(state.position.end(), fresh.position.begin(), fresh.position.end());
    state.velocity.insert(state.velocity.end(), fresh.velocity.begin(), fresh.velocity.end());
    state.spin.insert(state.spin.end(), fresh.spin.begin(), fresh.spin.end());
    scene.spheres.insert(scene.spheres.end(), added->begin(), added->end());
    if (auto fits = scene::fitSubsteps(scene); !fits) return refusal(fits.error());
    if (auto fits = scene::checkSpeeds(scene, scene.spheres.size() - added->size()); !fits)
        return tl::unexpected(fits.error());
    return Built{std::move(scene), std::move(state)};
}

}  // namespace

Result<Simulation::Outcome> Simulation::spawn(const v1::Spawn& spawn) {
    auto copies = memory::Claim::make("group", "adding spheres to those that there are", copiesToSpawn(plan()));
    if (!copies) return tl::unexpected(copies.error());
    auto live = liveState();
    if (!live) return tl::unexpected(live.error());
    return prepare(Anew::Spheres, std::move(*copies),
                   [group = spawn.group(), scene = scene_, state = std::move(*live)](Progress& progress) mutable {
                       return grownBy(group, std::move(scene), std::move(state), progress);
                   });
}

// Refuses an impulse that would make the sphere faster than the scene can compute.
Result<void> Simulation::checkPush(std::uint32_t id, const glm::dvec3& impulse) {
    const glm::dvec4 now(pipeline_->velocityOf(id));
    const glm::dvec3 velocity(now);
    const glm::dvec3 change = impulse * std::abs(now.w);
    const double radius = static_cast<double>(scene_.spheres[id].radius);
    // One that is faster already may still be slowed down.
    const double most = std::max(scene::farMotion * radius * mostSubsteps_ / scene_.step, glm::length(velocity));
    if (glm::length(velocity + change) <= most) return {};
    // The share of the impulse that makes it as fast as it can be.
    const double b = glm::dot(velocity, change);
    const double square = glm::dot(change, change);
    const double room = std::max(most * most - glm::dot(velocity, velocity), 0.0);
    const double share = (std::sqrt(b * b + square * room) - b) / square;
    return fail(ErrorKind::Refused, "impulse",
                fmt::format("is {:g} N s, which gives sphere {} {:g} m/s; the scene can compute {:g} m/s at most: give "
                            "it at most {:g} N s",
                            glm::length(impulse), id, glm::length(velocity + change), most,
                            std::max(share, 0.0) * glm::length(impulse)));
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
    if (auto bearable = checkPush(id, *impulse); !bearable) return tl::unexpected(bearable.error());
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
    message.set_sim_time(time());
    message.set_spheres(count());
    message.set_kinetic_energy(s.kineticEnergy);
    message.set_rotational_energy(s.rotationalEnergy);
    message.set_elastic_energy(s.elasticEnergy);
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
