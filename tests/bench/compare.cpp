#include "compare.h"

#include <chrono>

#include <spdlog/fmt/fmt.h>

#include "core/log.h"
#include "methods.h"
#include "recipe.h"

namespace spherule::bench {

namespace {

// Runs on until `time`, or until `budget` seconds have passed.
Result<void> runTo(sim::Simulation& simulation, double time, double budget) {
    const auto begin = std::chrono::steady_clock::now();
    while (simulation.time() < time - 0.5 * simulation.scene().step) {
        if (auto done = simulation.step(); !done) return done;
        if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > budget) break;
    }
    return {};
}

void describe(sim::Simulation& simulation, const std::string& state, Figures& figures) {
    const std::string table = "The " + state + " states";
    const std::uint32_t n = simulation.count();
    const sim::Statistics now = simulation.statistics();
    figures.push_back({table, n, "time", simulation.time(), "s", ""});
    figures.push_back({table, n, "rms speed", now.speedRms, "m/s", ""});
    figures.push_back({table, n, "contacts per sphere", static_cast<double>(now.contacts) / n, "", ""});
    figures.push_back({table, n, "mean overlap", 100 * now.overlapMean, "% of r", ""});
}

struct Contender {
    std::string name;
    std::unique_ptr<Method> method;
    std::string absence;  // why `method` is missing
};

std::vector<Contender> contenders(compute::Device& device, sim::Simulation& simulation) {
    const Setting setting = settingFor(device, simulation);
    std::vector<Contender> all;
    auto add = [&all](const char* name, Result<std::unique_ptr<Baseline>> method) {
        if (method) {
            all.push_back({name, std::move(*method), ""});
        } else {
            all.push_back({name, nullptr, method.error().text()});
        }
    };
    all.push_back({"ours", ours(simulation), ""});
    add("sweep and prune along x", sweepAndPrune(setting));
    add("cells of 2r, 64 slots, local size 64", slotsGrid(setting, fineGrid(setting, 64)));
    add("cells of 2r, 64 slots, local size 1", slotsGrid(setting, fineGrid(setting, 1)));
    add("student's grid", slotsGrid(setting, studentGrid(setting)));
    add("brute force", bruteForce(setting));
    return all;
}

void measure(compute::Device& device, sim::Simulation& simulation, const std::string& state, const Effort& effort,
             Figures& figures) {
    describe(simulation, state, figures);
    const sim::State from = simulation.snapshot();
    std::vector<Contender> all = contenders(device, simulation);
    std::vector<Method*> present;
    for (const Contender& contender : all)
        if (contender.method) present.push_back(contender.method.get());
    const std::vector<Timing> timings = race(device, present, from, effort);

    std::size_t next = 0;
    for (const Contender& contender : all) {
        Figure figure{"One substep, " + state, simulation.count(), contender.name, std::nullopt, "ms",
                      contender.absence};
        if (contender.method) {
            const Timing timing = timings[next++];
            figure.value = timing.seconds * 1e3;
            figure.note = contender.method->note();
            if (timing.rounds == 1) figure.note += (figure.note.empty() ? "" : "; ") + std::string("one substep only");
            spdlog::info("{} spheres, {}: {} {:.3f} ms", figure.spheres, state, figure.what, *figure.value);
        }
        figures.push_back(figure);
    }
    // The race has advanced the simulation; the next measurement starts from the same state.
    simulation.upload(from);
}

// Measures the overlap of the same bed under the baselines' contact law. It shows that a baseline does not reach the
// same result for less time.
Result<void> holdWithBaselines(compute::Device& device, sim::Simulation& simulation, Figures& figures) {
    const Setting setting = settingFor(device, simulation);
    auto method = slotsGrid(setting, fineGrid(setting, 64));
    if (!method) return tl::unexpected(method.error());
    (*method)->upload(simulation.snapshot());
    for (unsigned k = 0; k < 30 * substeps; ++k) (*method)->substep();
    figures.push_back({"The settled states", simulation.count(), "mean overlap 0.5 s later under the baselines' law",
                       100 * meanOverlap((*method)->positions()), "% of r", ""});
    return {};
}

}  // namespace

Result<void> compare(compute::Device& device, std::uint32_t spheres, const Moments& moments, const Effort& effort,
                     Figures& figures) {
    auto scene = box(spheres);
    if (!scene) return tl::unexpected(scene.error());
    auto made = sim::Simulation::create(device, std::move(*scene));
    if (!made) return tl::unexpected(made.error());
    sim::Simulation& simulation = **made;
    if (auto done = runTo(simulation, moments.falling, moments.settledBudget); !done) return done;
    measure(device, simulation, "falling", effort, figures);
    if (auto done = runTo(simulation, moments.settled, moments.settledBudget); !done) return done;
    measure(device, simulation, "settled", effort, figures);
    if (auto done = holdWithBaselines(device, simulation, figures); !done) return done;
    return device.status();
}

}  // namespace spherule::bench
