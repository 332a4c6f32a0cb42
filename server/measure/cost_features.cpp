#include <algorithm>
#include <functional>
#include <memory>

#include "measure/cases.h"
#include "measure/scenes.h"
#include "scene/random.h"

// The cost of a feature. Two simulations in the same state, one with it and one without it, run in turns.
namespace spherule::measure {

namespace {

using World = std::unique_ptr<sim::Simulation>;
using Change = std::function<void(scene::Scene&)>;

struct Feature {
    const char* name = nullptr;
    Change off;
    Change on;
    bool statistics = false;  // the simulation with the feature computes statistics after every step
    bool observed = false;    // the simulation without the feature does not observe impacts; otherwise both do
};

// One step of a round is observed.
constexpr int stepsPerRound = sim::observedEvery;

double medianOf(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

// Returns the state in which the scene comes to rest under the model `balanced`.
Result<sim::State> settled(Bench& bench, const scene::Scene& scene) {
    scene::Scene quick = scene;
    quick.quality = {.model = scene::Model::Balanced, .substeps = 8, .substepsFixed = true};
    auto opened = bench.openAsIs(quick);
    if (!opened) return tl::unexpected(opened.error());
    if (auto done = bench.run(**opened, bench.quick() ? 1 : 2); !done) return tl::unexpected(done.error());
    return (*opened)->snapshot();
}

Result<World> open(Bench& bench, scene::Scene scene, sim::State state, const Change& change) {
    change(scene);
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        state.position[id].w = scene.spheres[id].radius;
        state.velocity[id] = glm::vec4(0, 0, 0, std::abs(state.velocity[id].w));
    }
    auto opened = bench.openBySubstep(std::move(scene));
    if (opened) (*opened)->upload(state);
    return opened;
}

// Returns the device time per substep (s).
Result<double> timed(Bench& bench, sim::Simulation& simulation, int substeps, bool statistics) {
    static_cast<void>(bench.device().takeTimes());
    for (int k = 0; k < substeps; ++k) {
        if (auto done = simulation.step(); !done) return tl::unexpected(done.error());
        if (statistics) static_cast<void>(simulation.statistics());
    }
    double sum = 0;
    for (const double seconds : bench.device().takeTimes()) sum += seconds;
    return sum / substeps;
}

Result<void> compare(Bench& bench, const scene::Scene& scene, const sim::State& state, const Feature& feature) {
    auto without = open(bench, scene, state, feature.off);
    if (!without) return tl::unexpected(without.error());
    auto with = open(bench, scene, state, feature.on);
    if (!with) return tl::unexpected(with.error());
    if (feature.observed) (*without)->observe(false);
    const int rounds = bench.quick() ? 9 : 21;
    std::vector<double> off;
    std::vector<double> on;
    // The first round does not count, because it builds lists and fills caches.
    for (int round = 0; round <= rounds; ++round) {
        const auto first = timed(bench, **without, stepsPerRound, false);
        const auto second = timed(bench, **with, stepsPerRound, feature.statistics);
        if (!first) return tl::unexpected(first.error());
        if (!second) return tl::unexpected(second.error());
        if (round == 0) continue;
        off.push_back(*first);
        on.push_back(*second);
    }
    const std::string name = feature.name;
    bench.add(plain(name + ": substep without", medianOf(off) * 1e6, "us"));
    bench.add(plain(name + ": substep with", medianOf(on) * 1e6, "us"));
    bench.add(plain(name + ": with over without", medianOf(on) / medianOf(off), ""));
    const auto bytesOf = [](const World& world) { return static_cast<double>(world->plan().bytes()) / world->count(); };
    bench.add(plain(name + ": memory without", bytesOf(*without), "bytes per sphere"));
    bench.add(plain(name + ": memory with", bytesOf(*with), "bytes per sphere"));
    return {};
}

void rub(scene::Scene& scene) {
    setFriction(scene, 0.3);
}

const std::vector<Feature> features{
    {.name = "friction", .off = [](scene::Scene&) {}, .on = rub},
    {.name = "rolling resistance",
     .off = rub,
     .on =
         [](scene::Scene& scene) {
             rub(scene);
             scene.materials[0].rollingResistance = 0.05;
         }},
    {.name = "radii that differ",
     .off = [](scene::Scene&) {},
     .on =
         [](scene::Scene& scene) {
             // Vary radii by at most 1e-5, so that both scenes have the same contacts.
             scene::Random random(4);
             for (scene::Sphere& sphere : scene.spheres)
                 sphere.radius *= static_cast<float>(random.uniform(0.99999, 1.00001));
         }},
    {.name = "two materials",
     .off = [](scene::Scene&) {},
     .on =
         [](scene::Scene& scene) {
             addMaterial(scene, scene.materials[0]);
             for (std::size_t k = 0; k < scene.spheres.size(); k += 2) scene.spheres[k].material = 1;
         }},
    {.name = "sleep, nobody asleep",
     .off = [](scene::Scene&) {},
     .on =
         [](scene::Scene& scene) {
             scene.sleep.enabled = true;
             scene.sleep.time = 1e6;
         }},
    {.name = "impacts observed", .off = [](scene::Scene&) {}, .on = [](scene::Scene&) {}, .observed = true},
    {.name = "statistics every substep", .off = [](scene::Scene&) {}, .on = [](scene::Scene&) {}, .statistics = true},
};

Result<void> featureCosts(Bench& bench) {
    const scene::Scene scene = bench.quick() ? lattice(1000, 0.05, 8.1) : lattice(4000, 0.05, 14.2);
    const auto state = settled(bench, scene);
    if (!state) return tl::unexpected(state.error());
    for (const Feature& feature : features)
        if (auto done = compare(bench, scene, *state, feature); !done) return done;
    return {};
}

}  // namespace

std::vector<Case> featureCostCases() {
    return {{.suite = "cost", .name = "features", .run = featureCosts, .everyRung = false}};
}

}  // namespace spherule::measure
