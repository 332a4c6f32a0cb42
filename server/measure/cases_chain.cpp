#include <algorithm>
#include <cmath>

#include "measure/cases.h"
#include "measure/scenes.h"

// Five spheres in a row: the first hits the others, and the last should move on.
namespace spherule::measure {

namespace {

Result<void> cradle(Bench& bench, double gap, double speed) {
    constexpr double r = 0.05;
    scene::Scene scene = openSpace(4);
    setRestitution(scene, 1);
    addSphere(scene, {-2 * (2 * r + gap) - 0.1, 0, 0}, r, {speed, 0, 0});
    for (int k = -1; k <= 2; ++k) addSphere(scene, {k * (2 * r + gap), 0, 0}, r);
    auto opened = bench.open(scene);
    if (!opened) return tl::unexpected(opened.error());
    const double energy = kineticEnergyOf((*opened)->snapshot());
    if (auto done = bench.run(**opened, 0.6 / speed); !done) return done;
    const sim::State after = (*opened)->snapshot();
    double others = 0;
    for (std::uint32_t id = 0; id < 4; ++id) others = std::max(others, std::abs(velocityOf(after, id).x) / speed);
    bench.add(against("speed of the last over that put in", velocityOf(after, 4).x / speed, 1, ""));
    bench.add(against("fastest of the others", others, 0, "", 1));
    bench.add(against("energy over that put in", kineticEnergyOf(after) / energy, 1, ""));
    return {};
}

}  // namespace

std::vector<Case> chainCases() {
    return {{.suite = "accuracy",
             .name = "cradle, gaps of 1 %",
             .run = [](Bench& bench) { return cradle(bench, 0.001, 1); }},
            {.suite = "accuracy", .name = "cradle, touching", .run = [](Bench& bench) { return cradle(bench, 0, 1); }},
            {.suite = "accuracy",
             .name = "cradle, touching, 5 m/s",
             .run = [](Bench& bench) { return cradle(bench, 0, 5); },
             .whenQuick = false}};
}

}  // namespace spherule::measure
