// Many more spheres in one place than fit there.
#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "scene/quality.h"
#include "support.h"

namespace spherule::physics {
namespace {

// Spheres of `radius` that are all in one point. If `mixed`, one in fifty is ten times as large.
scene::Scene crowdOf(std::uint32_t count, float radius, bool mixed, scene::Model model) {
    scene::Scene scene = closedBox(2);
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

TEST(Crowd, FourThousandSpheresInOnePointMeetOnlySomeOfTheOthersAtATime) {
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

TEST(Crowd, AllNumbersOfThreadsGiveTheSameBits) {
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

}  // namespace
}  // namespace spherule::physics
