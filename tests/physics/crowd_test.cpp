// Many more spheres in one place than fit there.
#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "support.h"

namespace spherule::physics {
namespace {

// Spheres of `radius` that are all in one point. If `mixed`, one in fifty is ten times as large.
scene::Scene crowdOf(std::uint32_t count, float radius, bool mixed, scene::Model model) {
    scene::Scene scene = fineStepBox(2);
    scene.quality.model = model;
    if (model == scene::Model::Accurate) scene.quality.substeps = 8;
    for (std::uint32_t k = 0; k < count; ++k) {
        scene::Sphere sphere;
        sphere.radius = mixed && k % 50 == 0 ? 10 * radius : radius;
        sphere.position = {0.01, 0.02, 0.03};
        scene.spheres.push_back(sphere);
    }
    return scene;
}

TEST(Crowd, FourThousandSpheresAtOnePointHaveLimitedPairs) {
    for (const bool mixed : {false, true}) {
        const scene::Scene scene = crowdOf(4'000, 0.01F, mixed, scene::Model::Balanced);
        const auto simulation = simulate(scene);
        simulation->upload(sim::stateOf(scene));  // with the overlaps that a new simulation removes
        run(*simulation, scene.step);
        const sim::Simulation::Counters counters = simulation->counters();
        EXPECT_GT(counters.sampled, 0U);
        EXPECT_LE(counters.pairs, 128U * simulation->count());
        for (int k = 0; k < 40; ++k) {
            run(*simulation, scene.step);
            ASSERT_FALSE(simulation->counters().nonFinite);
        }
        EXPECT_TRUE(allFinite(simulation->snapshot()));
        EXPECT_EQ(simulation->statistics().outside, 0U);
    }
}

TEST(Crowd, StateIsTheSameForAnyNumberOfThreads) {
    for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate}) {
        std::optional<std::pair<std::uint64_t, std::uint64_t>> expected;
        for (const char* const choice : {"cpu:1", "cpu:2", "cpu:3", "cpu:8"}) {
            const auto on = compute::openDevice(choice).value();
            const scene::Scene scene = crowdOf(2'000, 0.01F, true, model);
            const auto simulation = simulate(scene, *on);
            const std::uint64_t apart = sim::hashOf(simulation->snapshot());
            simulation->upload(sim::stateOf(scene));
            run(*simulation, 0.05);
            const std::pair hashes(apart, sim::hashOf(simulation->snapshot()));
            if (!expected) expected = hashes;
            EXPECT_EQ(hashes, *expected) << scene::nameOf(model) << " on " << choice;
        }
    }
}

TEST(Crowd, ThreeThousandSpheresAtOnePointSeparate) {
    scene::Scene scene = fineStepBox(2);
    scene::Sphere sphere;
    sphere.radius = 0.02F;
    scene.spheres.assign(3000, sphere);
    const auto simulation = simulate(scene);
    simulation->upload(sim::stateOf(scene));
    run(*simulation, scene.step);
    EXPECT_GT(simulation->counters().unlisted, 0U);
    ASSERT_TRUE(allFinite(simulation->snapshot()));
    for (int k = 0; k < 240; ++k) {
        run(*simulation, scene.step);
        ASSERT_FALSE(simulation->counters().nonFinite);
    }
    EXPECT_EQ(simulation->counters().unlisted, 0U) << "there was room to make";
    const sim::Statistics statistics = simulation->statistics();
    EXPECT_EQ(statistics.nonFinite, 0U);
    EXPECT_EQ(statistics.outside, 0U);
    EXPECT_LT(statistics.overlapMax, 1.9) << "some have stayed where they were";
    EXPECT_TRUE(allFinite(simulation->snapshot()));
}

TEST(Crowd, TwoSpheresAtOnePointSeparateWithoutSpeed) {
    scene::Scene scene = fineStepSpace(2);
    scene.spheres.resize(2);
    for (scene::Sphere& sphere : scene.spheres) sphere.radius = 0.05F;
    const auto simulation = simulate(scene);
    run(*simulation, 0.1);
    const sim::State state = simulation->snapshot();
    ASSERT_TRUE(allFinite(state));
    EXPECT_NEAR(glm::length(positionOf(state, 0) - positionOf(state, 1)), 0.1, 1e-4);
    EXPECT_LT(glm::length(velocityOf(state, 0)), 1e-3);
}

}  // namespace
}  // namespace spherule::physics
