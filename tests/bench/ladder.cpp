#include "ladder.h"

#include <algorithm>

#include <spdlog/fmt/fmt.h>

#include "core/log.h"
#include "methods.h"
#include "recipe.h"
#include "stopwatch.h"

namespace spherule::bench {

namespace {

const std::string falling = "Ours by pass, falling";
const std::string dense = "Ours by pass, dense";
const std::string perSphere = "wall per sphere";

void measure(compute::Device& device, sim::Simulation& simulation, const std::string& table, unsigned rounds,
             Figures& figures) {
    const sim::State from = simulation.snapshot();
    const std::unique_ptr<Method> method = ours(simulation);
    timeSubsteps(device, *method, from, 2);

    std::vector<double> wall;
    std::vector<std::vector<double>> passes(sim::passCount);
    for (unsigned round = 0; round < rounds; ++round) {
        device.takeTimes();
        wall.push_back(timeSubsteps(device, *method, from, mostSubsteps) / mostSubsteps);
        const std::vector<double> times = device.takeTimes();
        for (std::size_t pass = 0; pass < times.size(); ++pass) passes.at(pass).push_back(times[pass] / mostSubsteps);
    }

    const std::uint32_t n = simulation.count();
    double all = 0;
    for (unsigned pass = 0; pass < sim::passCount; ++pass) {
        const double seconds = median(passes[pass]);
        if (seconds == 0) continue;  // not in this scene's plan
        all += seconds;
        figures.push_back({table, n, std::string(sim::nameOf(static_cast<sim::Pass>(pass))), seconds * 1e3, "ms", ""});
    }
    const double seconds = median(wall);
    figures.push_back({table, n, "all passes", all * 1e3, "ms", ""});
    figures.push_back({table, n, "wall", seconds * 1e3, "ms", method->note()});
    figures.push_back({table, n, perSphere, seconds / n * 1e9, "ns", ""});
    spdlog::info("{} spheres, {}: {:.3f} ms", n, table, seconds * 1e3);
    simulation.pipeline().upload(from);
}

}  // namespace

Result<void> climb(compute::Device& device, std::uint32_t spheres, unsigned steps, unsigned rounds, Figures& figures) {
    auto scene = box(spheres);
    if (!scene) return tl::unexpected(scene.error());
    auto made = sim::Simulation::create(device, std::move(*scene));
    if (!made) return tl::unexpected(made.error());
    sim::Simulation& simulation = **made;
    for (unsigned step = 0; step < steps; ++step)
        if (auto done = simulation.step(); !done) return done;
    measure(device, simulation, falling, rounds, figures);
    simulation.pipeline().upload(packed(simulation.scene()));
    if (auto done = simulation.step(); !done) return done;
    measure(device, simulation, dense, rounds, figures);
    return device.status();
}

std::string spreadOf(const Figures& figures) {
    std::vector<std::string> parts;
    for (const std::string& table : {falling, dense}) {
        double smallest = 1e300;
        double largest = 0;
        for (const Figure& figure : figures) {
            if (figure.table != table || figure.what != perSphere) continue;
            smallest = std::min(smallest, *figure.value);
            largest = std::max(largest, *figure.value);
        }
        if (largest > 0)
            parts.push_back(fmt::format("{} {:.2f}", table == falling ? "falling" : "dense", largest / smallest));
    }
    if (parts.empty()) return {};
    return fmt::format("Cost per sphere, largest over smallest of the ladder: {}", fmt::join(parts, ", "));
}

}  // namespace spherule::bench
