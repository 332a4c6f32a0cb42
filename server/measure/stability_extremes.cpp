#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "measure/cases.h"
#include "measure/scenes.h"
#include "measure/stability.h"

// Few spheres with extreme mass ratios, radius ratios or speeds.
namespace spherule::measure {

namespace {

constexpr double r = 0.05;
constexpr std::uint32_t starts = 40;

// Two separate stacks of two spheres: heavy on light, and light on heavy.
Result<void> massRatios(Bench& bench) {
    for (const double ratio : {1.0, 1e2, 1e4, 1e6}) {
        scene::Scene scene = closedBox(1);
        const auto heavy = addMaterial(scene, {.density = 1000 * ratio});
        for (const bool heavyAbove : {true, false}) {
            const double x = heavyAbove ? -0.2 : 0.2;
            addSphere(scene, {x, 0, -0.5 + r}, r, {}, heavyAbove ? std::uint8_t{0} : heavy);
            addSphere(scene, {x, 0, -0.5 + 3.05 * r}, r, {}, heavyAbove ? heavy : std::uint8_t{0});
        }
        auto opened = bench.open(scene);
        if (!opened) return tl::unexpected(opened.error());
        const Limits limits{.overlap = 1};
        if (auto done = survive(bench, **opened, fmt::format("1 : {:g}", ratio), 1, limits); !done) return done;
    }
    return {};
}

// A sphere falls on 25 spheres that are 100 times smaller.
Result<void> radiusRatio(Bench& bench) {
    constexpr double large = 0.5;
    constexpr double small = 0.005;
    scene::Scene scene = closedBox(2);
    for (int k = 0; k < 25; ++k) addSphere(scene, {0.011 * (k % 5 - 2), 0.011 * (k / 5 - 2), -1 + small}, small);
    addSphere(scene, {0, 0, -1 + large + 2.2 * small}, large);
    auto opened = bench.open(scene);
    if (!opened) return tl::unexpected(opened.error());
    return survive(bench, **opened, "1 : 100", 1, {.overlap = 1});
}

// Returns the height (m) at which sphere k starts. Heights differ, so that contacts begin at different instants within
// a substep.
double startOf(std::uint32_t k, double speed) {
    return 1 + 0.05 * k + 1e-4 * speed * k / starts;
}

// Opens the scene and runs it for `seconds`, rounded up to whole steps. The model `accurate` gets shorter steps,
// because it takes thousands of substeps per step.
Result<std::unique_ptr<sim::Simulation>> openFor(Bench& bench, scene::Scene scene, double seconds) {
    if (bench.accurate()) scene.step = std::min(scene.step, seconds);
    auto opened = bench.open(scene);
    if (!opened) return opened;
    const double whole = std::ceil(seconds / scene.step) * scene.step;
    if (auto done = bench.run(**opened, whole); !done) return tl::unexpected(done.error());
    return opened;
}

Result<void> atWall(Bench& bench) {
    for (const double speed : {1.0, 10.0, 100.0, 200.0, 1000.0}) {
        scene::Scene scene = closedBox(12);
        scene.forces.gravity = {};
        for (std::uint32_t k = 0; k < starts; ++k)
            addSphere(scene, {0.2 * k - 4, 0, -6 + startOf(k, speed)}, r, {0, 0, -speed});
        auto opened = openFor(bench, scene, 4 / speed);
        if (!opened) return tl::unexpected(opened.error());
        const sim::Statistics s = (*opened)->statistics();
        const std::uint32_t lost = s.outside + s.nonFinite;
        Figure figure = plain(fmt::format("{:g} m/s: lost", speed), lost, "of 40");
        figure.verdict = lost == 0 ? "pass" : fmt::format("fails: {} of {} lost at {:g} m/s", lost, starts, speed);
        bench.add(std::move(figure));
    }
    return {};
}

// Each sphere is shot at its own resting sphere. It has passed through if it ends behind that sphere.
Result<void> atSphere(Bench& bench) {
    for (const double speed : {1.0, 10.0, 100.0, 200.0, 1000.0}) {
        scene::Scene scene = openSpace(400);
        for (std::uint32_t k = 0; k < starts; ++k) {
            addSphere(scene, {0.2 * k - 4, 0, startOf(k, speed)}, r, {0, 0, -speed});
            addSphere(scene, {0.2 * k - 4, 0, 0}, r);
        }
        auto opened = openFor(bench, scene, 4 / speed);
        if (!opened) return tl::unexpected(opened.error());
        const sim::State state = (*opened)->snapshot();
        int passed = 0;
        for (std::uint32_t k = 0; k < starts; ++k)
            if (!(positionOf(state, 2 * k).z > positionOf(state, 2 * k + 1).z)) ++passed;
        Figure figure = plain(fmt::format("{:g} m/s: passed through", speed), passed, "of 40");
        figure.verdict =
            passed == 0 ? "pass" : fmt::format("fails: {} of {} pass through at {:g} m/s", passed, starts, speed);
        bench.add(std::move(figure));
    }
    return {};
}

Result<void> farOut(Bench& bench) {
    for (const double side : {10.0, 100.0, 1000.0}) {
        scene::Scene scene = closedBox(side);
        setRestitution(scene, 1);
        addSphere(scene, {-0.5 * side + 1, -0.5 * side + 1, -0.5 * side + r + 0.5}, r);
        auto opened = bench.open(scene);
        if (!opened) return tl::unexpected(opened.error());
        const Limits limits{.energyRise = 0.01};
        const std::string name = fmt::format("bounces in the corner of a box of {:g} m", side);
        if (auto done = survive(bench, **opened, name, 2, limits); !done) return done;
    }
    return {};
}

Case stability(const char* name, Result<void> (*run)(Bench&)) {
    return {.suite = "stability", .name = name, .run = run, .everyRung = false};
}

}  // namespace

std::vector<Case> extremeCases() {
    return {stability("mass ratio", massRatios), stability("radius ratio", radiusRatio),
            stability("fast at a wall", atWall), stability("fast at a sphere", atSphere),
            stability("far from the origin", farOut)};
}

}  // namespace spherule::measure
