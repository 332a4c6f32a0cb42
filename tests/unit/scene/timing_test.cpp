#include <gtest/gtest.h>

#include <cmath>

#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

constexpr double frame = 1.0 / 60;

// Returns the substeps for one sphere of this radius (m); 0: no sphere.
double substepsFor(double step, double gravity, double radius, Model model = Model::Balanced) {
    Scene scene;
    scene.step = step;
    scene.forces.gravity = {0, 0, -gravity};
    scene.quality.model = model;
    if (radius > 0) scene.spheres.push_back({.radius = static_cast<float>(radius)});
    return defaultSubsteps(scene);
}

std::string sphereOf(const std::string& radius) {
    return group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.5], "radius": )" + radius + "}]}");
}

TEST(SceneTiming, FiveCentimetresOnEarthTakeEightSubsteps) {
    EXPECT_EQ(substepsFor(frame, 9.81, 0.05), 8);
}

TEST(SceneTiming, LargeOrWeightlessSpheresHaveTheLongestSubstep) {
    EXPECT_EQ(substepsFor(frame, 9.81, 5), 8);
    EXPECT_EQ(substepsFor(frame, 0, 0.001), 8);
    EXPECT_EQ(substepsFor(frame, 9.81, 0), 8) << "no spheres yet";
    EXPECT_EQ(substepsFor(1.0 / 480, 0, 1), 1);
    EXPECT_EQ(substepsFor(1e-6, 0, 1), 1);
}

TEST(SceneTiming, SubstepsGrowWithTheRootOfGravityOverRadius) {
    // h = sqrt(8.5e-4 * 0.0125 / 9.81) = 1.0407e-3 s: 16.01 substeps, which the slack rounds to 16.
    EXPECT_EQ(substepsFor(frame, 9.81, 0.0125), 16);
    EXPECT_EQ(substepsFor(frame, 4 * 9.81, 0.05), 16);
    EXPECT_EQ(substepsFor(frame, 9.81, 0.005), 26);  // 25.32
}

TEST(SceneTiming, SmallestSphereDeterminesSubsteps) {
    Scene scene;
    scene.forces.gravity = {0, 0, -9.81};
    for (const float radius : {0.05F, 0.0125F, 0.1F}) scene.spheres.push_back({.radius = radius});
    EXPECT_EQ(defaultSubsteps(scene), 16);
}

TEST(SceneTiming, FastModelNeedsAQuarterOfTheSubsteps) {
    EXPECT_EQ(substepsFor(frame, 9.81, 0.05, Model::Fast), 2);
    EXPECT_EQ(substepsFor(frame, 9.81, 0.0125, Model::Fast), 4);
    EXPECT_EQ(substepsFor(frame, 9.81, 0.005, Model::Fast), 7);  // 6.33
    EXPECT_EQ(substepsFor(1.0 / 480, 0, 1, Model::Fast), 1);
}

TEST(SceneTiming, AccurateModelNeedsSeventySubstepsPerContact) {
    // The slowest expected impact (0.1 m/s) compresses the spring by 0.01 * 5 cm. The contact time is then pi * 5 ms:
    // 74.27 substeps.
    const auto substeps = [](const std::string& overlap) {
        const std::string quality = R"("quality": {"model": "ACCURATE", "overlap": )" + overlap + "}, ";
        return sceneWith(R"("gravity": [0, 0, 0], )" + quality + sphereOf("0.05")).quality.substeps;
    };
    EXPECT_EQ(substeps("0.01"), 75U);
    EXPECT_EQ(substeps("0.001"), 743U);
    EXPECT_EQ(substeps("0.1"), 8U);
}

TEST(SceneTiming, HugeSubstepCountsDoNotOverflow) {
    const double expected = 1 / std::sqrt(8.5e-4 * 1e-6 / 1e30);
    EXPECT_NEAR(substepsFor(1, 1e30, 1e-6) / expected, 0.99, 1e-6);
    EXPECT_GT(expected, maxSubsteps);
}

TEST(SceneTiming, GivenSubstepsReplaceTheDefault) {
    EXPECT_EQ(sceneWith(R"("quality": {"substeps": 3})").quality.substeps, 3U);
    EXPECT_EQ(sceneWith(R"("quality": {"substeps": 3})", {.substeps = 5}).quality.substeps, 5U);
    EXPECT_EQ(sceneWith(R"("quality": {"substeps": 3, "model": "ACCURATE"})").quality.substeps, 3U);
    EXPECT_EQ(sceneWith(sphereOf("0.0125")).quality.substeps, 16U);
    EXPECT_EQ(sceneWith(R"("step": 0.1)").quality.substeps, 48U);
}

}  // namespace
}  // namespace spherule::scene::testing
