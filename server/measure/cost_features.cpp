#include <algorithm>
#include <memory>

#include "measure/cases.h"
#include "measure/scenes.h"
#include "sim/modules/module.h"

// The cost of a feature. Two simulations in the same state, one with it and one without it, run in turns.
namespace spherule::measure {

namespace {

using SimulationPtr = std::unique_ptr<sim::Simulation>;

// A row of the table, in terms of a module's CostComparison.
struct Row {
    sim::CostComparison comparison;
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

Result<SimulationPtr> open(Bench& bench, scene::Scene scene, sim::State state, void (*change)(scene::Scene&)) {
    if (change != nullptr) change(scene);
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

Result<void> compare(Bench& bench, const scene::Scene& scene, const sim::State& state, const Row& row) {
    auto without = open(bench, scene, state, row.comparison.without);
    if (!without) return tl::unexpected(without.error());
    auto with = open(bench, scene, state, row.comparison.with);
    if (!with) return tl::unexpected(with.error());
    if (row.observed) (*without)->observe(false);
    const int rounds = bench.quick() ? 9 : 21;
    std::vector<double> off;
    std::vector<double> on;
    // The first round does not count, because it builds lists and fills caches.
    for (int round = 0; round <= rounds; ++round) {
        const auto first = timed(bench, **without, stepsPerRound, false);
        const auto second = timed(bench, **with, stepsPerRound, row.statistics);
        if (!first) return tl::unexpected(first.error());
        if (!second) return tl::unexpected(second.error());
        if (round == 0) continue;
        off.push_back(*first);
        on.push_back(*second);
    }
    const std::string name(row.comparison.name);
    bench.add(plain(name + ": substep without", medianOf(off) * 1e6, "us"));
    bench.add(plain(name + ": substep with", medianOf(on) * 1e6, "us"));
    bench.add(plain(name + ": with over without", medianOf(on) / medianOf(off), ""));
    const auto bytesOf = [](const SimulationPtr& simulation) {
        return static_cast<double>(simulation->plan().bytes()) / simulation->count();
    };
    bench.add(plain(name + ": memory without", bytesOf(*without), "bytes per sphere"));
    bench.add(plain(name + ": memory with", bytesOf(*with), "bytes per sphere"));
    return {};
}

// Returns a row for each feature that can be switched in a scene, and a row for the statistics.
std::vector<Row> rows() {
    std::vector<Row> all;
    for (const sim::Module* module : sim::modules())
        if (!module->cost.name.empty())
            all.push_back({.comparison = module->cost, .observed = module->feature == sim::Feature::Impacts});
    all.push_back({.comparison = {.name = "statistics every substep"}, .statistics = true});
    return all;
}

Result<void> featureCosts(Bench& bench) {
    const scene::Scene scene = bench.quick() ? lattice(1000, 0.05, 11.3) : lattice(4000, 0.05, 14.2);
    const auto state = settled(bench, scene);
    if (!state) return tl::unexpected(state.error());
    for (const Row& row : rows())
        if (auto done = compare(bench, scene, *state, row); !done) return done;
    return {};
}

}  // namespace

std::vector<Case> featureCostCases() {
    return {{.suite = "cost", .name = "features", .run = featureCosts, .everyRung = false}};
}

}  // namespace spherule::measure
