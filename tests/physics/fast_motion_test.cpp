#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "scene/quality.h"
#include "support.h"

// Fast spheres do not pass through obstacles: the simulation uses more substeps while a sphere moves too far in one.
namespace spherule::physics {
namespace {

constexpr scene::Model models[] = {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate};

// Spheres side by side, one at each of the heights above the middle, which fly towards the floor.
scene::Scene shots(scene::Model model, double speed, const std::vector<double>& heights) {
    scene::Scene scene = fineStepBox(4);
    scene.step = 1.0 / 60;
    scene.quality = {.model = model, .substeps = 8, .substepsFixed = false};
    for (std::size_t k = 0; k < heights.size(); ++k)
        scene.spheres.push_back(
            {.position = {0.4 * static_cast<double>(k % 8) - 1.4, 0.4 * static_cast<double>(k / 8) - 0.8, heights[k]},
             .velocity = {0, 0, static_cast<float>(-speed)},
             .radius = 0.05F});
    if (auto fits = scene::fitSubsteps(scene); !fits) throw std::runtime_error(fits.error().text());
    return scene;
}

TEST(FastMotion, FloorStopsFastSpheresInEveryModel) {
    std::vector<double> heights;
    for (int k = 0; k < 40; ++k) heights.push_back(0.5 + 0.017 * k);
    for (const scene::Model model : models) {
        // At 1,000 m/s, springs would need hundreds of thousands of substeps.
        const auto simulation = simulate(shots(model, model == scene::Model::Accurate ? 100 : 1000, heights));
        run(*simulation, scene::Scene{}.step);  // all spheres reach the floor in this time
        const sim::Statistics statistics = simulation->statistics();
        EXPECT_EQ(statistics.outside, 0U) << scene::nameOf(model);
        EXPECT_EQ(statistics.nonFinite, 0U) << scene::nameOf(model);
    }
}

TEST(FastMotion, RaisesSubstepsTemporarilyWithoutANotice) {
    scene::Scene scene = shots(scene::Model::Balanced, 200, {0});
    setRestitution(scene, 0);
    const auto simulation = simulate(scene);
    EXPECT_GE(simulation->substeps(), 130U) << "200 m/s over 1/60 s in steps of half a radius";
    run(*simulation, 0.5);
    EXPECT_EQ(simulation->substeps(), 8U);
    EXPECT_TRUE(simulation->takeNotices().empty()) << "no sphere can pass through another";
}

TEST(FastMotion, GivesNoticeIfTheMostSubstepsAreTooFew) {
    const auto simulation = simulate(shots(scene::Model::Balanced, 20'000, {0}));
    const auto notices = simulation->takeNotices();
    ASSERT_EQ(notices.size(), 1U);
    EXPECT_NE(notices[0].find("may pass through"), std::string::npos) << notices[0];
}

TEST(FastMotion, GivesNoticeOnceIfTheMostSubstepsBecomeTooFew) {
    scene::Scene scene = shots(scene::Model::Balanced, 370, {0});
    scene.quality.substeps = 1;
    scene.forces.gravity = {0, 0, -1e4F};
    setRestitution(scene, 1);
    const auto simulation = simulate(scene);
    EXPECT_GT(simulation->substeps(), 240U);
    EXPECT_TRUE(simulation->takeNotices().empty()) << "256 substeps are enough";
    run(*simulation, 0.15);
    EXPECT_EQ(simulation->takeNotices().size(), 1U) << "near the floor, the sphere has up to 420 m/s";
}

TEST(FastMotion, DoesNotAffectARunAfterReset) {
    const auto simulation = simulate(shots(scene::Model::Balanced, 200, {0, 0.3, 0.5}));
    run(*simulation, 0.3);
    const std::uint64_t first = sim::hashOf(simulation->snapshot());
    ASSERT_TRUE(simulation->apply(sim::Reset()));
    run(*simulation, 0.3);
    EXPECT_EQ(sim::hashOf(simulation->snapshot()), first);
}

TEST(FastMotion, TriesFewerSubstepsAgainButNotAtEveryStep) {
    // 0.6 radii per step: two substeps are enough, one is not.
    scene::Scene scene = shots(scene::Model::Fast, 0, {0});
    scene.forces.gravity = {};
    scene.bounds.min = glm::dvec3(-100);
    scene.bounds.max = glm::dvec3(100);
    scene.quality = {.model = scene::Model::Fast, .substeps = 1, .substepsFixed = true};
    scene.spheres[0].velocity = {0, 0, -0.6F * 0.05F * 60};
    const auto simulation = simulate(scene);
    int changes = 0;
    for (int step = 0; step < 300; ++step) {
        const std::uint32_t before = simulation->substeps();
        ASSERT_TRUE(simulation->step());
        if (simulation->substeps() != before) ++changes;
    }
    EXPECT_GE(changes, 2) << "it is tried whether one is enough by now";
    EXPECT_LE(changes, 20) << "of 300 steps";
}

TEST(FastMotion, AfterAPushRaisesSubstepsBeforeTheNextStep) {
    scene::Scene scene = shots(scene::Model::Balanced, 0, {-1.9});
    const auto simulation = simulate(scene);
    ASSERT_TRUE(simulation->apply(sim::Push{.target = 0U, .impulse = {0, 0, -300}}));
    EXPECT_GT(simulation->substeps(), 300U);
    run(*simulation, 0.1);
    EXPECT_EQ(simulation->statistics().outside, 0U);
}

}  // namespace
}  // namespace spherule::physics
