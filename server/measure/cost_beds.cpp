#include <cmath>

#include <fmt/format.h>

#include "measure/cases.h"
#include "measure/scenes.h"

// Beds of ever more spheres, twenty deep, until simulating them takes longer than they would.
namespace spherule::measure {

namespace {

Result<void> beds(Bench& bench) {
    constexpr double longest = 1;  // device seconds per simulated second
    const double growth = bench.quick() ? 2 : std::sqrt(2.0);
    const double settle = bench.quick() ? 0.25 : 2;
    const double watch = bench.quick() ? 0.1 : 0.25;
    double largest = 0;
    double cost = 0;
    for (double wanted = bench.accurate() ? 125 : 1000; wanted < 4e6; wanted *= growth) {
        const auto count = static_cast<std::uint32_t>(wanted);
        auto opened = bench.open(lattice(count, 0.05, std::max(4.0, 1.1 * std::sqrt(wanted / 20))));
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

}  // namespace

std::vector<Case> bedCostCases() {
    return {{.suite = "cost", .name = "beds", .run = beds, .everyRung = false}};
}

}  // namespace spherule::measure
