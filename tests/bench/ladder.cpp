#include "ladder.h"

#include <algorithm>
#include <array>

#include <spdlog/fmt/fmt.h>

#include "core/log.h"
#include "methods.h"
#include "recipe.h"
#include "stopwatch.h"

namespace spherule::bench {

namespace {

struct State {
    std::string name;
    Arrangement arrangement;

    [[nodiscard]] std::string table() const { return "Ours by pass, " + name; }
};
const std::array states = {State{"falling", falling}, State{"dense", dense}};

const std::string perSphere = "wall per sphere";

struct Rung {
    std::unique_ptr<sim::Simulation> simulation;
    std::unique_ptr<Method> method;
    sim::State state;
    unsigned every = 1;                         // takes part in every n-th round
    std::vector<double> wall{};                 // s per substep, by round
    std::vector<std::vector<double>> passes{};  // device s per substep, by pass and round
};

Result<Rung> rungFor(compute::Device& device, std::uint32_t spheres, double friction) {
    auto scene = box(spheres, friction);
    if (!scene) return tl::unexpected(scene.error());
    auto made = sim::Simulation::create(device, std::move(*scene));
    if (!made) return tl::unexpected(made.error());
    Rung rung{.simulation = std::move(*made), .method = nullptr, .state = {}};
    rung.method = ours(*rung.simulation);
    return rung;
}

// Runs one step, in which the simulation allocates memory for the number of pairs.
Result<void> letGo(Rung& rung, const Arrangement& arrangement) {
    sim::Simulation& simulation = *rung.simulation;
    simulation.upload(arranged(simulation.scene(), arrangement));
    if (auto done = simulation.step(); !done) return done;
    rung.state = simulation.snapshot();
    return {};
}

void runRound(compute::Device& device, Rung& rung) {
    device.takeTimes();
    rung.wall.push_back(timeSubsteps(device, *rung.method, rung.state, mostSubsteps) / mostSubsteps);
    std::vector<double> times = device.takeTimes();
    times.resize(sim::passCount);
    for (std::size_t pass = 0; pass < times.size(); ++pass) rung.passes[pass].push_back(times[pass] / mostSubsteps);
}

void report(Rung& rung, const std::string& table, Figures& figures) {
    const std::uint32_t n = rung.simulation->count();
    double all = 0;
    for (unsigned pass = 0; pass < sim::passCount; ++pass) {
        const double seconds = median(rung.passes[pass]);
        if (seconds == 0) continue;  // the plan of this scene has no such pass
        all += seconds;
        figures.push_back({table, n, std::string(sim::nameOf(static_cast<sim::Pass>(pass))), seconds * 1e3, "ms", ""});
    }
    const double seconds = median(rung.wall);
    figures.push_back({table, n, "all passes", all * 1e3, "ms", ""});
    figures.push_back({table, n, "wall", seconds * 1e3, "ms", rung.method->note()});
    figures.push_back({table, n, perSphere, seconds / n * 1e9, "ns", ""});
    spdlog::info("{}: {} spheres {:.3f} ms", table, n, seconds * 1e3);
}

void measure(compute::Device& device, std::span<Rung> rungs, const std::string& table, unsigned rounds,
             Figures& figures) {
    for (Rung& rung : rungs) {
        rung.wall.clear();
        rung.passes.assign(sim::passCount, {});
        const double seconds = timeSubsteps(device, *rung.method, rung.state, mostSubsteps);
        rung.every = seconds > 4 ? 4 : seconds > 1 ? 2 : 1;
    }
    for (unsigned round = 0; round < rounds; ++round)
        for (Rung& rung : rungs)
            if (round % rung.every == 0) runRound(device, rung);
    for (Rung& rung : rungs) report(rung, table, figures);
}

double spread(const Figures& figures, const std::string& table) {
    double smallest = 1e300;
    double largest = 0;
    for (const Figure& figure : figures) {
        if (figure.table != table || figure.what != perSphere) continue;
        smallest = std::min(smallest, *figure.value);
        largest = std::max(largest, *figure.value);
    }
    return largest / smallest;
}

}  // namespace

Result<void> climb(compute::Device& device, std::span<const std::uint32_t> sizes, double friction, unsigned rounds,
                   Figures& figures) {
    std::vector<Rung> rungs;
    for (const std::uint32_t size : sizes) {
        auto rung = rungFor(device, size, friction);
        if (!rung) return tl::unexpected(rung.error());
        rungs.push_back(std::move(*rung));
    }
    for (const State& state : states) {
        for (Rung& rung : rungs)
            if (auto done = letGo(rung, state.arrangement); !done) return done;
        measure(device, rungs, state.table(), rounds, figures);
    }
    return device.status();
}

std::string spreadOf(const Figures& figures) {
    std::vector<std::string> parts;
    for (const State& state : states) {
        const double ratio = spread(figures, state.table());
        if (ratio > 0) parts.push_back(fmt::format("{} {:.2f}", state.name, ratio));
    }
    if (parts.empty()) return {};
    return fmt::format("Cost per sphere, largest over smallest of the ladder: {}", fmt::join(parts, ", "));
}

}  // namespace spherule::bench
