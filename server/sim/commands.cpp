#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "scene/group.h"
#include "scene/load.h"
#include "scene/materials.h"
#include "scene/quality.h"
#include "sim/commands.h"
#include "sim/memory_needs.h"
#include "sim/parameters.h"
#include "sim/picking.h"
#include "sim/simulation.h"

namespace spherule::sim {

namespace {

constexpr double maxGravity = 1e6;   // m/s^2
constexpr double maxDistance = 1e9;  // m

tl::unexpected<Error> refusal(const Error& error) {
    // The command names a field of the quality without its prefix.
    constexpr std::string_view prefix = "quality.";
    const bool quality = error.where.starts_with(prefix);
    return fail(ErrorKind::Refused, quality ? error.where.substr(prefix.size()) : error.where, error.message,
                error.cause, error.limits);
}

Result<void> setGravity(scene::Scene& scene, const Set& set) {
    if (!set.gravity) return {};
    if (!(glm::length(*set.gravity) <= maxGravity))
        return fail(ErrorKind::Refused, "gravity",
                    fmt::format("is {:g} m/s^2 long, at most {:g} is allowed", glm::length(*set.gravity), maxGravity),
                    Cause::Range, {.least = {}, .most = maxGravity});
    scene.forces.gravity = *set.gravity;
    if (const auto rests = scene::checkLiquids(scene); !rests)
        return fail(ErrorKind::Refused, "gravity", rests.error().where + " " + rests.error().message);
    return {};
}

// Sets a property of all materials, and removes the property's values from all pairs.
Result<void> setMaterials(scene::Scene& scene, double value, double most, const char* name,
                          double scene::Material::*ofMaterial, std::optional<double> scene::MaterialPair::*ofPair) {
    if (!(value >= 0 && value <= most))
        return fail(ErrorKind::Refused, name, fmt::format("is {:g}, must be within 0 and {:g}", value, most),
                    Cause::Range, {.least = 0, .most = most});
    for (scene::Material& material : scene.materials) material.*ofMaterial = value;
    for (scene::MaterialPair& pair : scene.pairs) (pair.*ofPair).reset();
    return {};
}

Result<void> setRestitution(scene::Scene& scene, const Set& set) {
    if (!set.restitution) return {};
    return setMaterials(scene, *set.restitution, 1, "restitution", &scene::Material::restitution,
                        &scene::MaterialPair::restitution);
}

Result<void> setFriction(scene::Scene& scene, const Set& set) {
    if (!set.friction) return {};
    return setMaterials(scene, *set.friction, scene::largestFriction, "friction", &scene::Material::friction,
                        &scene::MaterialPair::friction);
}

// Frees the substeps, so that fitSubsteps() chooses them for the new model. setSubsteps() runs later: substeps in the
// same command take precedence.
Result<void> setModel(scene::Scene& scene, const Set& set) {
    if (!set.model) return {};
    scene.quality.model = *set.model;
    scene.quality.substepsFixed = false;
    scene.quality.goal.reset();
    if (auto fits = scene::checkModel(scene); !fits) return refusal(fits.error());
    return {};
}

Result<void> setSubsteps(scene::Scene& scene, const Set& set) {
    if (!set.substeps) return {};
    scene.quality.substepsFixed = true;
    scene.quality.substeps = *set.substeps;
    scene.quality.goal.reset();
    return {};
}

Result<void> setGoal(scene::Scene& scene, const Set& set) {
    if (set.goal) scene.quality.goal = *set.goal;
    return {};
}

// Returns the scene with the spheres of the group added, and the states of all spheres. `state`: the states of the
// present spheres. `time`: s simulated.
Result<SceneAndState> withGroup(const Spawn& spawn, scene::Scene scene, State state, double time, Progress& progress) {
    scene.time = time;
    const glm::dvec3 centre = scene.bounds.centre();
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        const glm::dvec3 now = glm::dvec3(state.position[id]);
        // A sphere without a finite position, or very far away, keeps its initial position.
        if (glm::dot(now, now) < maxDistance * maxDistance) scene.spheres[id].position = now + centre;
    }
    // Groups whose spheres are all gone make way for new ones.
    if (scene.groups.size() >= scene::maxGroups) scene::removeEmptyGroups(scene);
    auto added = spawn.place(scene, progress);
    if (!added) return tl::unexpected(added.error());
    if (added->empty()) return fail(ErrorKind::Refused, "group", "has no spheres");
    scene.groups.push_back(scene::groupOf(*added, spawn.name, spawn.look));
    state.append(stateOf(scene, *added));
    scene.spheres.insert(scene.spheres.end(), added->begin(), added->end());
    if (auto fits = scene::fitSubsteps(scene); !fits) return refusal(fits.error());
    if (auto fits = scene::checkSpeeds(scene, scene.spheres.size() - added->size()); !fits)
        return tl::unexpected(fits.error());
    return SceneAndState{std::move(scene), std::move(state)};
}

}  // namespace

Result<scene::Scene> changedBy(const Set& set, scene::Scene scene) {
    for (auto part : {setGravity, setRestitution, setFriction, setModel, setSubsteps, setGoal})
        if (auto done = part(scene, set); !done) return tl::unexpected(done.error());
    // The longest usable substep depends on gravity and on the model.
    if (auto fits = scene::fitSubsteps(scene); !fits) return refusal(fits.error());
    return scene;
}

// Carries out each kind of Command.
class Simulation::CommandHandler {
  public:
    explicit CommandHandler(Simulation& simulation) : simulation_(simulation) {}

    Result<Outcome> operator()(const Set& set);
    Result<Outcome> operator()(const Reset& reset);
    Result<Outcome> operator()(const Spawn& spawn);
    Result<Outcome> operator()(const Remove& remove);
    Result<Outcome> operator()(const ChangeObstacle& change) { return simulation_.changeObstacle(change); }
    Result<Outcome> operator()(const ChangePart& change) { return simulation_.changePart(change); }
    Result<Outcome> operator()(const RemoveGroup& remove) { return simulation_.removeGroup(remove); }
    Result<Outcome> operator()(const Push& push);
    Result<Outcome> operator()(const Pull& pull);
    Result<Outcome> operator()(const Release& release);

  private:
    // Ranks, see Population.
    Result<std::uint32_t> targetOf(const Push& push);
    Result<void> checkMoves(std::uint32_t rank);
    Result<std::vector<std::uint32_t>> ranksOf(const Remove& remove);
    Result<void> checkPush(std::uint32_t rank, const glm::dvec3& impulse);

    Simulation& simulation_;
};

Result<Simulation::Outcome> Simulation::begin(const Command& command) {
    auto outcome = std::visit(CommandHandler(*this), command);
    if (outcome) outcome->applied.step = steps_;
    return outcome;
}

Result<Applied> Simulation::apply(const Command& command) {
    auto outcome = begin(command);
    if (!outcome) return tl::unexpected(outcome.error());
    if (!outcome->preparation) return std::move(outcome->applied);
    if (auto done = outcome->preparation->finish(); !done) return tl::unexpected(done.error());
    return adopt(std::move(outcome->preparation));
}

Result<Simulation::Outcome> Simulation::CommandHandler::operator()(const Set& set) {
    const bool disturbs = set.gravity || set.restitution || set.friction || set.model;
    if (!disturbs && !set.substeps && !set.goal) return {};
    auto changed = changedBy(set, simulation_.scene_);
    if (!changed) return tl::unexpected(changed.error());
    return simulation_.change(std::move(*changed), disturbs);
}

// Features do not depend on the number of substeps, so the command needs no preparation.
Result<void> Simulation::chooseSubsteps(std::uint32_t substeps) {
    scene::Scene changed = scene_;
    changed.quality.substepsFixed = true;
    changed.quality.substeps = substeps;
    if (auto fits = scene::fitSubsteps(changed); !fits) return refusal(fits.error());
    auto outcome = change(std::move(changed), false);
    if (!outcome) return tl::unexpected(outcome.error());
    return {};
}

Result<Simulation::Outcome> Simulation::change(scene::Scene changed, bool disturbs) {
    changed.time = time();
    // The plan may have more features than the present spheres require, if some were removed.
    if (featuresOf(changed) == featuresOf(scene_)) {
        closeContactSums();
        scene_ = std::move(changed);
        maxSubsteps_ = scene::maxRaisedSubsteps(scene_);
        ++partsVersion_;
        writeConstants(*pipeline_, scene_);
        useSubsteps(scene_.quality.substeps);
        openContactSums();
        // A change of the substeps alone wakes no sphere.
        if (disturbs) pipeline_->wakeAll();
        return {};
    }
    auto copies = memory::Claim::make("", "a change of the scene", copiesToChange(plan()));
    if (!copies) return tl::unexpected(copies.error());
    auto state = liveState();
    if (!state) return tl::unexpected(state.error());
    return prepare(ResetScope::Nothing, std::move(*copies), SceneAndState{std::move(changed), std::move(*state)});
}

Result<Simulation::Outcome> Simulation::CommandHandler::operator()(const Reset& /*reset*/) {
    auto copies = memory::Claim::make("", "the scene as it began", copiesToChange(simulation_.plan()));
    if (!copies) return tl::unexpected(copies.error());
    const scene::Scene& initial = simulation_.initial_;
    return simulation_.prepare(ResetScope::World, std::move(*copies), SceneAndState{initial, stateOf(initial)});
}

Result<Simulation::Outcome> Simulation::CommandHandler::operator()(const Spawn& spawn) {
    auto copies =
        memory::Claim::make("group", "adding spheres to those that there are", copiesToSpawn(simulation_.plan()));
    if (!copies) return tl::unexpected(copies.error());
    auto live = simulation_.liveState();
    if (!live) return tl::unexpected(live.error());
    return simulation_.prepareSpawn(std::move(*copies), [spawn, scene = simulation_.scene_, state = std::move(*live),
                                                         time = simulation_.time()](Progress& progress) mutable {
        return withGroup(spawn, std::move(scene), std::move(state), time, progress);
    });
}

Result<Simulation::Outcome> Simulation::CommandHandler::operator()(const Push& push) {
    const auto rank = targetOf(push);
    if (!rank) return tl::unexpected(rank.error());
    const scene::Scene& scene = simulation_.scene_;
    const scene::Sphere& sphere = scene.spheres[*rank];
    const std::uint64_t id = simulation_.population_.idAt(*rank);
    if (auto moves = checkMoves(*rank); !moves) return tl::unexpected(moves.error());
    if (auto slow = checkPush(*rank, push.impulse); !slow) return tl::unexpected(slow.error());
    Pipeline& pipeline = *simulation_.pipeline_;
    const std::uint32_t handle = simulation_.population_.handleAt(*rank);
    pipeline.applyImpulse(handle, glm::vec3(push.impulse));
    const double speed = glm::length(glm::dvec3(pipeline.velocityOf(handle)));
    const double moved = speed * scene.step / simulation_.substeps_ / static_cast<double>(sphere.radius);
    if (moved > static_cast<double>(SAFE_MOTION)) simulation_.limitMotionPerSubstep(moved);
    return Outcome{.applied = {.sphere = id}};
}

Result<Simulation::Outcome> Simulation::CommandHandler::operator()(const Pull& pull) {
    const auto rank = rankOf(simulation_.population_, pull.sphere, "sphere");
    if (!rank) return tl::unexpected(rank.error());
    if (auto moves = checkMoves(*rank); !moves) return tl::unexpected(moves.error());
    if (!(glm::length(pull.point) <= maxDistance))
        return fail(ErrorKind::Refused, "point", fmt::format("is farther than {:g} m from the origin", maxDistance),
                    Cause::Range, {.least = {}, .most = maxDistance});
    const auto force = simulation_.pull(pull, *rank);
    if (!force) return tl::unexpected(force.error());
    return Outcome{.applied = {.sphere = pull.sphere, .force = *force}};
}

Result<Simulation::Outcome> Simulation::CommandHandler::operator()(const Release& release) {
    simulation_.release(release.session);
    return Outcome{};
}

Result<void> Simulation::CommandHandler::checkMoves(std::uint32_t rank) {
    if (!simulation_.scene_.spheres[rank].fixed) return {};
    return fail(ErrorKind::Refused, "",
                fmt::format("sphere {} is fixed: nothing moves it", simulation_.population_.idAt(rank)),
                Cause::FixedSphere);
}

Result<std::vector<std::uint32_t>> Simulation::CommandHandler::ranksOf(const Remove& remove) {
    std::vector<std::uint32_t> ranks;
    for (std::size_t k = 0; k < remove.spheres.size(); ++k) {
        const auto rank = rankOf(simulation_.population_, remove.spheres[k], "spheres");
        if (!rank)
            return fail(ErrorKind::Refused, fmt::format("spheres[{}]", k), rank.error().message, Cause::NoSuchSphere);
        ranks.push_back(*rank);
    }
    if (remove.region) {
        const auto live = simulation_.liveState();
        if (!live) return tl::unexpected(live.error());
        const State& state = *live;
        const glm::dvec3 centre = simulation_.scene_.bounds.centre();
        const std::size_t named = ranks.size();
        for (std::uint32_t rank = 0; rank < state.count(); ++rank)
            if (remove.region->contains(positionOf(state, rank) + centre)) ranks.push_back(rank);
        if (ranks.size() == named)
            return fail(ErrorKind::Refused, "region", "has no sphere's centre in it", Cause::NoHit);
    }
    std::ranges::sort(ranks);
    ranks.erase(std::ranges::unique(ranks).begin(), ranks.end());
    return ranks;
}

Result<Simulation::Outcome> Simulation::CommandHandler::operator()(const Remove& remove) {
    const auto copies = memory::Claim::make("", "removing spheres", copiesToChange(simulation_.plan()));
    if (!copies) return tl::unexpected(copies.error());
    const auto ranks = ranksOf(remove);
    if (!ranks) return tl::unexpected(ranks.error());
    if (ranks->empty()) return fail(ErrorKind::Refused, "", "names no sphere and no region");
    if (auto done = simulation_.remove(*ranks); !done) return tl::unexpected(done.error());
    return Outcome{.applied = {.removed = static_cast<std::uint32_t>(ranks->size())}};
}

// Returns the rank of the sphere to push.
Result<std::uint32_t> Simulation::CommandHandler::targetOf(const Push& push) {
    if (const auto* const ray = std::get_if<Ray>(&push.target)) {
        const double length = glm::length(ray->direction);
        if (!(length > 0)) return fail(ErrorKind::Refused, "ray.direction", "has no length");
        const glm::dvec3 origin = ray->origin - simulation_.scene_.bounds.centre();
        const auto hit =
            firstHit(simulation_.snapshot(), origin, ray->direction / length, simulation_.scene_.bounds.periods());
        if (!hit) return fail(ErrorKind::Refused, "ray", "meets no sphere", Cause::NoHit);
        return *hit;
    }
    return rankOf(simulation_.population_, std::get<std::uint64_t>(push.target), "sphere");
}

// The speed (m/s) up to which the motion of a sphere of this radius can be limited to a safe one.
double Simulation::maxSpeed(double radius) const {
    return scene::safeMotion * radius * maxSubsteps_ / scene_.step;
}

double Simulation::maxImpulse() const {
    const auto denser = [](const auto& a, const auto& b) { return a.density < b.density; };
    const double density = std::ranges::max_element(scene_.materials, denser)->density;
    const double radius = radii_.largest;
    return 4.0 / 3 * std::numbers::pi * radius * radius * radius * density * maxSpeed(radius);
}

// Refuses an impulse that would make the sphere faster than the scene can compute.
Result<void> Simulation::CommandHandler::checkPush(std::uint32_t rank, const glm::dvec3& impulse) {
    const scene::Scene& scene = simulation_.scene_;
    const glm::dvec4 now(simulation_.pipeline_->velocityOf(simulation_.population_.handleAt(rank)));
    const glm::dvec3 velocity(now);
    const glm::dvec3 change = impulse * std::abs(now.w);
    const double radius = static_cast<double>(scene.spheres[rank].radius);
    // A sphere that is already faster may still be slowed down.
    const double most = std::max(simulation_.maxSpeed(radius), glm::length(velocity));
    if (glm::length(velocity + change) <= most) return {};
    // The share of the impulse that gives the sphere the largest speed allowed.
    const double b = glm::dot(velocity, change);
    const double square = glm::dot(change, change);
    const double room = std::max(most * most - glm::dot(velocity, velocity), 0.0);
    const double share = (std::sqrt(b * b + square * room) - b) / square;
    const double allowed = std::max(share, 0.0) * glm::length(impulse);
    return fail(ErrorKind::Refused, "impulse",
                fmt::format("is {:g} N s, which gives sphere {} {:g} m/s; the scene can compute {:g} m/s at most: give "
                            "it at most {:g} N s",
                            glm::length(impulse), simulation_.population_.idAt(rank), glm::length(velocity + change),
                            most, allowed),
                Cause::Range, {.least = 0, .most = allowed});
}

}  // namespace spherule::sim
