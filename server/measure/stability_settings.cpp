#include <cmath>

#include <fmt/format.h>

#include "measure/cases.h"
#include "measure/scenes.h"
#include "measure/stability.h"
#include "scene/quality.h"

// A few spheres, with settings at the limits of their ranges.
namespace spherule::measure {

namespace {

// A heap in a box that is closed on all sides, so that no sphere may leave.
scene::Scene heap(std::uint32_t count) {
    scene::Scene scene = lattice(count, 0.05, 5);
    scene.bounds.open.fill(false);
    return scene;
}

Result<void> substeps(Bench& bench) {
    for (const double substep : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
        scene::Scene scene = heap(64);
        scene.step = substep;
        scene.quality = {.model = bench.model(), .substeps = 1, .substepsFixed = true};
        if (const auto fits = scene::fitSubsteps(scene); !fits) {
            Figure refused = plain(fmt::format("substeps of {:g} s", substep), 0, "of the energy");
            refused.verdict = "refused: " + fits.error().text();
            bench.add(std::move(refused));
            continue;
        }
        auto opened = bench.openAsIs(scene);
        if (!opened) return tl::unexpected(opened.error());
        if (auto done = survive(bench, **opened, fmt::format("substeps of {:g} s", substep), 2); !done) return done;
    }
    return {};
}

Result<void> gravities(Bench& bench) {
    for (const double gravity : {0.0, 1e-3, 1.0, 100.0, 1e4}) {
        scene::Scene scene = heap(64);
        scene.forces.gravity = {0, 0, -gravity};
        auto opened = bench.open(scene);
        if (!opened) return tl::unexpected(opened.error());
        if (auto done = survive(bench, **opened, fmt::format("{:g} m/s^2", gravity), 1); !done) return done;
    }
    return {};
}

Result<void> restitutions(Bench& bench) {
    for (const double e : {0.0, 1.0}) {
        scene::Scene scene = heap(64);
        setRestitution(scene, e);
        auto opened = bench.open(scene);
        if (!opened) return tl::unexpected(opened.error());
        if (auto done = survive(bench, **opened, fmt::format("restitution {:g}", e), 2); !done) return done;
    }
    return {};
}

// Spheres in one place: they should separate, but not much faster than in a fall over one radius.
Result<void> inOnePlace(Bench& bench, std::uint32_t count, double seconds) {
    constexpr double most = 1;  // m/s
    scene::Scene scene = closedBox(8);
    scene.forces.gravity = {};
    for (std::uint32_t k = 0; k < count; ++k) addSphere(scene, {}, 0.05);
    auto opened = bench.open(scene);
    if (!opened) return tl::unexpected(opened.error());
    if (auto done = bench.run(**opened, seconds); !done) return done;
    const sim::Statistics s = (*opened)->statistics();
    Figure figure = plain(fmt::format("{} spheres: fastest afterwards", count), s.speedMax, "m/s");
    if (s.nonFinite > 0)
        figure.verdict = fmt::format("fails: {} not finite", s.nonFinite);
    else if (s.outside > 0)
        figure.verdict = fmt::format("fails: {} outside the bounds", s.outside);
    else if (s.speedMax > most)
        figure.verdict = fmt::format("fails: come apart at {:.3g} m/s", s.speedMax);
    else if (s.overlapMax > 1)
        figure.verdict = fmt::format("fails: overlap of {:.3g} r is left", s.overlapMax);
    else
        figure.verdict = "pass";
    bench.add(std::move(figure));
    return {};
}

Result<void> fewInOnePlace(Bench& bench) {
    for (const std::uint32_t count : {2U, 27U})
        if (auto done = inOnePlace(bench, count, 0.2); !done) return done;
    return {};
}

Result<void> manyInOnePlace(Bench& bench) {
    return inOnePlace(bench, 10'000, 0.05);
}

Result<void> hardlyAny(Bench& bench) {
    for (const std::uint32_t count : {0U, 1U, 2U}) {
        auto opened = bench.open(heap(count));
        if (!opened) return tl::unexpected(opened.error());
        if (auto done = survive(bench, **opened, fmt::format("{} spheres", count), 1); !done) return done;
    }
    return {};
}

Case stability(const char* name, Result<void> (*run)(Bench&), bool whenQuick = true) {
    return {.suite = "stability", .name = name, .run = run, .everyRung = false, .whenQuick = whenQuick};
}

}  // namespace

std::vector<Case> settingCases() {
    return {stability("length of a substep", substeps), stability("gravity", gravities),
            stability("restitution", restitutions), stability("all in one place", fewInOnePlace),
            stability("hardly any spheres", hardlyAny)};
}

std::vector<Case> crowdCases() {
    return {stability("10,000 in one place", manyInOnePlace, false)};
}

}  // namespace spherule::measure
