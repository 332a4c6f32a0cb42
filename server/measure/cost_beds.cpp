#include <cmath>

#include <fmt/format.h>

#include "measure/cases.h"
#include "measure/scenes.h"

// The cost of beds.
namespace spherule::measure {

namespace {

// Beds with friction, 20 layers deep, of more and more spheres, until a bed is slower than real time.
Result<void> beds(Bench& bench) {
    constexpr double longest = 1;  // device seconds per simulated second
    const double growth = bench.quick() ? 2 : std::sqrt(2.0);
    const double settle = bench.quick() ? 0.25 : 2;
    const double watch = bench.quick() ? 0.1 : 0.25;
    double largest = 0;
    double cost = 0;
    for (double wanted = bench.accurate() ? 125 : 1000; wanted < 4e6; wanted *= growth) {
        const auto count = static_cast<std::uint32_t>(wanted);
        scene::Scene scene = lattice(count, 0.05, std::max(4.0, 1.1 * std::sqrt(wanted / 20)));
        setFriction(scene, 0.3);
        auto opened = bench.open(std::move(scene));
        if (!opened) return tl::unexpected(opened.error());
        if (auto done = bench.run(**opened, settle); !done) return done;
        bench.startClock();
        if (auto done = bench.run(**opened, watch); !done) return done;
        const double took = takeSubstepSeconds(bench.device()) / watch;
        bench.add(plain(fmt::format("{} spheres", count), took, "s per simulated s"));
        if (took > longest) break;
        largest = wanted;
        cost = took;
    }
    bench.add(plain("largest bed in real time", std::floor(largest), "spheres"));
    bench.add(plain("cost of it", cost, "s per simulated s"));
    return {};
}

// Beds of equal spheres with one larger sphere above.
Result<void> sizes(Bench& bench) {
    constexpr double radius = 0.01;
    const std::uint32_t count = (bench.quick() ? 2'000 : 20'000) / (bench.accurate() ? 10 : 1);
    const double settle = (bench.quick() ? 0.1 : 0.5) / (bench.accurate() ? 5 : 1);
    for (const double ratio : {1.0, 10.0, 30.0, 100.0}) {
        scene::Scene scene = lattice(count, radius, std::max(1.2 * ratio, std::sqrt(count / 10.0)));
        double top = scene.bounds.min.z;
        for (const scene::Sphere& sphere : scene.spheres) top = std::max(top, sphere.position.z + radius);
        scene.bounds.max.z = std::max(scene.bounds.max.z, top + 3 * ratio * radius);
        addSphere(scene, {0, 0, top + ratio * radius}, ratio * radius);
        auto opened = bench.open(std::move(scene));
        if (!opened) return tl::unexpected(opened.error());
        sim::Simulation& simulation = **opened;
        if (auto done = bench.run(simulation, settle); !done) return done;
        bench.startClock();
        std::uint32_t substeps = 0;
        for (int k = 0; k < (bench.accurate() ? 1 : 6); ++k) {
            substeps += simulation.substeps();
            if (auto done = bench.step(simulation); !done) return done;
        }
        const double took = takeSubstepSeconds(bench.device()) / substeps;
        const sim::Statistics statistics = simulation.statistics();
        const std::string name = fmt::format("one of {}, the others of 1", ratio);
        bench.add(plain(name + ": substep", 1e6 * took, "us"));
        bench.add(plain(name + ": pairs listed", simulation.counters().pairs, ""));
        bench.add(plain(name + ": overlapping", static_cast<double>(statistics.contacts), ""));
        bench.add(plain(name + ": classes of sizes", static_cast<double>(simulation.plan().grid.sizes()), ""));
        const double bytes = static_cast<double>(simulation.plan().bytes()) / simulation.count();
        bench.add(plain(name + ": memory", bytes, "bytes per sphere"));
    }
    return {};
}

}  // namespace

std::vector<Case> bedCostCases() {
    return {{.suite = "cost", .name = "beds", .run = beds, .everyRung = false},
            {.suite = "cost", .name = "sizes", .run = sizes, .everyRung = false}};
}

}  // namespace spherule::measure
