#include "runs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <ostream>
#include <span>

#include "codec_support.h"
#include "mixtures.h"
#include "scene/quality.h"
#include "scene/random.h"
#include "sim/inspection.h"
#include "support.h"

namespace spherule::instruments {
namespace {

using physics::run;
using physics::simulate;
using support::valueOf;

constexpr scene::Model models[] = {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate};

constexpr std::size_t mostSpheres = 20'000;  // of a shipped scene in the short form

// Substeps of a shipped scene; nullopt: the short form.
std::optional<int> askedSubsteps() {
    const char* const asked = std::getenv("SPHERULE_INSTRUMENT_SUBSTEPS");
    return asked == nullptr ? std::nullopt : std::optional<int>(std::stoi(asked));
}

template <class T>
std::uint64_t hashOf(std::span<const T> values) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (const std::byte byte : std::as_bytes(values))
        hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3U;
    return hash;
}

void addStatistics(Digest& digest, sim::Simulation& simulation) {
    const sim::Statistics now = simulation.statistics();
    for (const double value :
         {now.kineticEnergy, now.rotationalEnergy, now.elasticEnergy, now.potentialEnergy, now.momentum.x,
          now.overlapMean, now.overlapMax, now.wallOverlapMax, now.impacts.count, now.impacts.approach})
        digest.push_back(std::bit_cast<std::uint64_t>(value));
    digest.push_back(now.contacts);
    digest.push_back(now.sleeping);
    if (now.contactSums) digest.push_back(std::bit_cast<std::uint64_t>(now.contactSums->dissipated));
}

void addState(Digest& digest, sim::Simulation& simulation) {
    digest.push_back(sim::hashOf(simulation.snapshot()));
    addStatistics(digest, simulation);
    digest.push_back(hashOf<std::uint32_t>(simulation.contactCounts()));
    valueOf(simulation.pipeline().figures());
    digest.push_back(hashOf<glm::vec4>(simulation.pipeline().read<glm::vec4>(sim::figuresArray, simulation.count())));
}

// Returns the bits of the state and of its statistics after `seconds` of simulated time.
Digest resultsOf(const scene::Scene& scene, double seconds) {
    const auto device = valueOf(compute::openDevice("cpu:1x1"));
    const auto simulation = simulate(scene, *device);
    Digest digest;
    const long steps = std::lround(seconds / scene.step);
    for (long k = 1; k <= steps; ++k) {
        run(*simulation, scene.step);
        if (k == steps / 2) addStatistics(digest, *simulation);
    }
    addState(digest, *simulation);
    return digest;
}

Digest resultsOfScene(const scene::Scene& scene) {
    const auto device = valueOf(compute::openDevice("cpu:1x1"));
    const auto simulation = simulate(scene, *device);
    for (int k = 0; k < askedSubsteps().value_or(3); ++k) valueOf(simulation->advance());
    Digest digest;
    addState(digest, *simulation);
    return digest;
}

// An emitter of slow spheres in the upper part of a mixture.
scene::Emitter slowEmitter() {
    scene::Emitter emitter = physics::named("fountain").emitters.at(0);
    emitter.region = scene::Box{{-0.2, -0.2, 0.3}, {0.2, 0.2, 0.4}};
    emitter.velocity = {};
    emitter.velocitySpread = 0;
    emitter.material = 0;
    emitter.group = 0;
    emitter.expected = 10;
    for (scene::Sphere& sample : emitter.samples)
        sample = {.position = {0, 0, 0.35}, .radius = sample.radius, .material = 0};
    return emitter;
}

Digest resultsOfCommands(scene::Model model) {
    scene::Scene scene = physics::mixture(model);
    scene.contactSums = true;
    scene.sleep.enabled = true;
    scene.sinks = {{{-0.5, -0.5, -0.5}, {-0.3, 0.5, -0.3}}};
    scene.groups = {{.name = "all", .count = static_cast<std::uint32_t>(scene.spheres.size()), .look = {}}};
    scene.emitters = {slowEmitter()};
    scene.obstacles.push_back(physics::obstacleFrom(
        R"({"capsule": {"from": [-0.3, 0.2, -0.3], "to": [0.3, 0.2, -0.3], "radius": 0.05}, "motion": {"spin": [3, 0, 0]}})"));
    const auto device = valueOf(compute::openDevice("cpu:1x1"));
    const auto simulation = simulate(scene, *device);
    Digest digest;
    const auto apply = [&](const sim::Command& command) {
        valueOf(simulation->apply(command));
        run(*simulation, scene.step);
        addState(digest, *simulation);
    };
    run(*simulation, (model == scene::Model::Accurate ? 2 : 20) * scene.step);
    apply(sim::Push{.target = std::uint64_t{7}, .impulse = {0.01, 0, 0.02}});
    apply(sim::Pull{.session = 1, .sphere = 9, .point = {0.1, 0.1, 0.3}});
    for (const std::uint64_t id : {9U, 11U}) {
        const sim::Inspection seen = valueOf(sim::inspect(*simulation, id, "sphere"));
        digest.push_back(std::bit_cast<std::uint64_t>(seen.position.x));
        digest.push_back(seen.touches);
        for (const sim::TouchedBody& body : seen.contacts) digest.push_back(std::bit_cast<std::uint64_t>(body.overlap));
    }
    apply(sim::Remove{.spheres = {3, 5, 100}});
    apply(sim::Spawn{.name = "new", .look = {}, .place = [](const scene::Scene&, Progress&) {
                         return Result<std::vector<scene::Sphere>>({{.position = {0.05, 0.02, 0.38}, .radius = 0.03F},
                                                                    {.position = {0.2, 0.02, 0.38}, .radius = 0.03F}});
                     }});
    apply(sim::ChangeObstacle{.obstacle = std::nullopt, .make = [](const scene::Scene&) {
                                  return Result<std::optional<scene::Obstacle>>(physics::obstacleFrom(
                                      R"({"sphere": {"centre": [0.3, 0.3, 0.36], "radius": 0.03}})"));
                              }});
    apply(sim::ChangeObstacle{.obstacle = 0U, .make = [](const scene::Scene&) {
                                  return Result<std::optional<scene::Obstacle>>(std::nullopt);
                              }});
    if (model != scene::Model::Accurate) apply(sim::Set{.substeps = scene.quality.substeps + 1});
    apply(sim::Set{.gravity = glm::dvec3(1, 0, -5)});
    apply(sim::Set{.friction = 0.2});
    apply(sim::Release{.session = 1});
    return digest;
}

// A bed that comes to rest, is hit, and so wakes.
scene::Scene sleepers(scene::Model model) {
    scene::Scene scene = physics::sleepyBox(0.6);
    scene.quality.model = model;
    for (int k = 0; k < 60; ++k)
        measure::addSphere(scene, {0.1 * (k % 5) - 0.2, 0.1 * (k / 5 % 4) - 0.15, -0.25 + 0.1 * (k / 20)}, 0.05F);
    measure::addSphere(scene, {0.03, 0.01, 2}, 0.05F);
    scene.bounds.max.z = 3;
    scene.bounds.min.z = -0.3;
    return scene;
}

// Spheres that hold contacts are moved to other places. Later all are moved to one place, so that the lists have no
// room for their pairs.
Digest resultsOfMoves(scene::Model model) {
    const auto device = valueOf(compute::openDevice("cpu:1x1"));
    scene::Scene scene = sleepers(model);
    const auto simulation = simulate(scene, *device);
    Digest digest;
    run(*simulation, 0.3);
    sim::Pipeline& pipeline = simulation->pipeline();
    auto places = pipeline.read<glm::vec4>(sim::Array::Position, simulation->count());
    for (std::size_t slot = 0; slot < places.size(); slot += 5) places[slot].z += 0.5F;
    pipeline.write<glm::vec4>(sim::Array::Position, places);
    pipeline.requestRebuild();
    run(*simulation, scene.step);
    addState(digest, *simulation);
    for (scene::Sphere& sphere : scene.spheres) sphere.position *= 0.2;
    simulation->upload(sim::stateOf(scene));
    run(*simulation, scene.step);
    addState(digest, *simulation);
    return digest;
}

// Spheres in one place: cells are overfull.
scene::Scene crowd(scene::Model model) {
    scene::Scene scene = physics::sleepyBox(1);
    scene.quality.model = model;
    scene::Random random(2);
    for (int k = 0; k < 700; ++k) {
        const double reach = k < 500 ? 0.02 : 0.3;
        const auto aside = [&] { return random.uniform(-reach, reach); };
        measure::addSphere(scene, {aside(), aside(), aside()}, k % 3 == 0 ? 0.02F : 0.01F);
    }
    return scene;
}

// Spheres that leave the bounds.
scene::Scene openMixture(scene::Model model) {
    scene::Scene scene = physics::mixture(model);
    scene.bounds.open.fill(true);
    for (scene::Sphere& sphere : scene.spheres) sphere.velocity.x += 6;
    return scene;
}

Digest resultsOfEncoder() {
    constexpr std::uint32_t spheres = 5000;
    codec::Encoder encoder("cpu:1x1", spheres);
    codec::Motion motion(spheres, 9);
    Digest digest;
    const auto add = [&](const codec::Bytes& frame) { digest.push_back(hashOf<std::byte>(frame)); };
    add(encoder.begin(codec::positionsAt(motion.next())));
    for (int k = 0; k < 6; ++k) {
        add(encoder.next(codec::positionsAt(motion.next())));
        if (k == 3) add(encoder.join());
    }
    return digest;
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const Trial& trial) {
    return out << trial.name;
}

std::vector<Trial> mixtureTrials() {
    std::vector<Trial> trials;
    const auto add = [&](const std::string& name, scene::Model model, double seconds, auto make) {
        trials.push_back(
            {name + "_" + std::string(scene::nameOf(model)), [=] { return resultsOf(make(model), seconds); }});
    };
    for (const scene::Model model : models) {
        const double seconds = model == scene::Model::Accurate ? 0.01 : 0.05;
        add("mixture", model, seconds, physics::mixture);
        add("in_fields", model, seconds, physics::mixtureInFields);
        add("in_media", model, seconds, physics::mixtureInMedia);
        add("among_meshes", model, seconds, physics::mixtureAmongMeshes);
        add("among_obstacles", model, seconds, physics::mixtureAmongObstacles);
        add("among_moving_obstacles", model, seconds, physics::mixtureAmongMovingObstacles);
        add("periodic", model, seconds, [](scene::Model of) { return physics::periodicMixture(of, 1); });
        add("periodic_sizes", model, seconds, [](scene::Model of) { return physics::periodicMixture(of, 10); });
        add("sizes_1_to_10", model, seconds, [](scene::Model of) { return physics::mixedBed(of, 10); });
        add("sizes_1_to_100", model, seconds / 2, [](scene::Model of) { return physics::mixedBed(of, 100); });
        if (model != scene::Model::Accurate) {
            add("crowd", model, 0.05, crowd);
            add("sleepers", model, 0.7, sleepers);
            add("movers", model, 0.3, physics::layerUnderRain);
            trials.push_back({"moves_" + std::string(scene::nameOf(model)), [=] { return resultsOfMoves(model); }});
        }
        add("open", model, seconds, openMixture);
        trials.push_back({"commands_" + std::string(scene::nameOf(model)), [=] { return resultsOfCommands(model); }});
    }
    trials.push_back({"encoder", resultsOfEncoder});
    return trials;
}

std::vector<Trial> coveringTrials() {
    std::vector<Trial> trials = mixtureTrials();
    std::erase_if(trials, [](const Trial& trial) {
        return std::ranges::none_of(
            std::initializer_list<const char*>{"commands_fast", "commands_balanced", "commands_accurate",
                                               "moves_balanced", "movers_balanced", "open_balanced", "crowd_balanced",
                                               "periodic_sizes_balanced", "among_moving_obstacles_balanced",
                                               "in_fields_accurate", "in_media_balanced", "encoder"},
            [&](const char* name) { return trial.name == name; });
    });
    return trials;
}

std::vector<Trial> sceneTrials() {
    std::vector<Trial> trials;
    for (const std::string& name : scene::names()) {
        std::string title = name;
        std::ranges::replace(title, '-', '_');
        trials.push_back({title, [=] {
                              Digest digest;
                              for (const scene::Model model : models) {
                                  const auto scene = scene::load(name, "software", {.model = model});
                                  if (!scene) continue;  // the model lacks a feature of the scene
                                  if (!askedSubsteps() && scene->spheres.size() > mostSpheres) continue;
                                  std::ranges::copy(resultsOfScene(*scene), std::back_inserter(digest));
                              }
                              return digest;
                          }});
    }
    return trials;
}

}  // namespace spherule::instruments
