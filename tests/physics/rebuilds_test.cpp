#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <vector>

#include "scene/quality.h"
#include "sim/layout.h"
#include "support.h"

// The host launches the kernels of a rebuild only in substeps in which one may be due.
namespace spherule::physics {
namespace {

using sim::Array;

std::vector<std::uint32_t> countersOf(sim::Simulation& simulation) {
    return simulation.pipeline().read<std::uint32_t>(Array::Counters);
}

void advance(sim::Simulation& simulation) {
    if (auto done = simulation.advance(); !done) throw std::runtime_error(done.error().text());
}

// A heavy sphere hits a row of light ones at rest, each lighter than the one before, from `speed` on faster and faster.
scene::Scene row(double speed) {
    scene::Scene scene = fineStepSpace(20);
    setRestitution(scene, 1);
    float radius = 0.4F;
    double x = -6;
    for (int k = 0; k < 6; ++k) {
        scene.spheres.push_back({.position = {x, 0, 0}, .radius = radius});
        x += 1.6 * static_cast<double>(radius);
        radius *= 0.7F;
        x += static_cast<double>(radius);
    }
    scene.spheres[0].velocity = {static_cast<float>(speed), 0, 0};
    scene.spheres[0].position.x -= 1;
    return scene;
}

// Returns in how many substeps a rebuild was due but had not been launched.
unsigned lateRebuilds(sim::Simulation& simulation, unsigned substeps) {
    const bool balanced = simulation.plan().features.has(sim::Feature::Balanced);
    unsigned late = 0;
    std::vector<std::uint32_t> before = countersOf(simulation);
    for (unsigned k = 0; k < substeps; ++k) {
        advance(simulation);
        const std::vector<std::uint32_t> now = countersOf(simulation);
        const bool rebuilt = now[COUNTER_REBUILDS] != before[COUNTER_REBUILDS];
        // `balanced` asks at the end of a substep, the others before the lists are used.
        const bool due = ((balanced ? before : now)[COUNTER_REBUILD] & REBUILD_DUE) != 0;
        late += due && !rebuilt && k > 0 ? 1 : 0;
        before = now;
    }
    return late;
}

TEST(Rebuilds, AreLaunchedWhenTheyAreDue) {
    for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate})
        for (const char* const name : {"box-4k", "billiards", "rapids-3k", "pour"}) {
            const auto simulation = simulate(named(name, {.model = model}));
            // `fast` moves overlapping spheres apart without giving them a speed, which nothing foresees.
            const unsigned most = model == scene::Model::Fast ? 2 : 0;
            EXPECT_LE(lateRebuilds(*simulation, 200), most) << name << ", " << scene::nameOf(model);
            if (model != scene::Model::Accurate) {
                EXPECT_GT(countersOf(*simulation)[COUNTER_REBUILDS], 0U) << name;
            }
        }
}

TEST(Rebuilds, AreLaunchedWhenAnImpactSpeedsUpRestingSpheres) {
    for (const double speed : {1.0, 3.0, 10.0, 20.0, 30.0, 50.0, 70.0, 90.0}) {
        const auto simulation = simulate(row(speed));
        EXPECT_EQ(lateRebuilds(*simulation, 2000 / static_cast<unsigned>(speed) + 100), 0U) << speed;
        EXPECT_GT(simulation->snapshot().velocity.back().x, speed) << "the last sphere was hit";
    }
}

// The lists move with spheres that all have one velocity. The floor turns back the first one.
TEST(Rebuilds, AreLaunchedWhenACommonFlightMeetsTheFloor) {
    for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced})
        for (const double share : {0.1, 0.2, 0.3, 0.4, 0.49}) {  // of the radius, in a substep
            scene::Scene scene = fineStepBox(20);
            scene.quality.model = model;
            scene.forces.gravity = {};
            setRestitution(scene, 1);
            constexpr double radius = 0.05;
            for (int k = 0; k < 12; ++k)
                scene.spheres.push_back({.position = {0, 0, -9.5 + 3.1 * radius * k},
                                         .velocity = {0, 0, static_cast<float>(-share * radius * 480)},
                                         .radius = static_cast<float>(radius)});
            const auto simulation = simulate(scene);
            EXPECT_EQ(lateRebuilds(*simulation, static_cast<unsigned>(60 / share)), 0U)
                << share << ", " << scene::nameOf(model);
            EXPECT_GT(simulation->snapshot().velocity.back().z, 0) << "the last one was turned back";
        }
}

TEST(Rebuilds, AreNotLaunchedInABedAtRest) {
    scene::Scene scene = named("box-4k");
    scene.sleep.enabled = false;
    for (scene::Material& material : scene.materials) material.friction = 0.4;
    const auto simulation = simulate(scene);
    run(*simulation, 3);
    const sim::SubstepCost usual = sim::costOf(simulation->plan(), false);
    const sim::SubstepCost rebuilding = sim::costOf(simulation->plan(), true);
    EXPECT_LE(usual.launches, 30U);
    const auto observing = static_cast<std::uint32_t>(
        std::ranges::count_if(simulation->plan().substep, [](const sim::LaunchSpec& one) { return one.observing; }));
    constexpr unsigned substeps = 480;
    unsigned without = 0;
    for (unsigned k = 0; k < substeps; ++k) {
        const std::uint64_t before = simulation->pipeline().launches();
        advance(*simulation);
        const auto launches = static_cast<std::uint32_t>(simulation->pipeline().launches() - before);
        // In the substep after a rebuild, the host does not know yet whether the new lists have room for all pairs.
        const std::set<std::uint32_t> expected{usual.launches, usual.launches + 8, rebuilding.launches};
        EXPECT_TRUE(expected.contains(launches) || expected.contains(launches - observing))
            << launches << " of " << usual.launches << " or " << rebuilding.launches;
        without += launches <= 30 ? 1 : 0;
    }
    EXPECT_GT(without, substeps / 2);
}

TEST(Rebuilds, AllowFewBatchesInARow) {
    const auto simulation = simulate(named("box-4k"));
    run(*simulation, 1);
    EXPECT_LE(simulation->pipeline().longestChain(), 160U);
    EXPECT_GT(simulation->pipeline().longestChain(), 100U) << "a dense bed";
}

}  // namespace
}  // namespace spherule::physics
