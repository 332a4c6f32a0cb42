#include <gtest/gtest.h>

#include <limits>

#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

constexpr double frame = 1.0 / 60;

TEST(SceneTiming, FiveCentimetresOnEarthTakeEightSubsteps) {
    EXPECT_EQ(defaultSubsteps(frame, 9.81, 0.05), 8U);
    EXPECT_EQ(defaultSubsteps(frame, 9.81, static_cast<double>(0.05F)), 8U);
}

TEST(SceneTiming, LargeOrWeightlessSpheresTakeTheLongestSubstep) {
    EXPECT_EQ(defaultSubsteps(frame, 9.81, 5), 8U);
    EXPECT_EQ(defaultSubsteps(frame, 0, 0.001), 8U);
    EXPECT_EQ(defaultSubsteps(frame, 9.81, 0), 8U) << "no spheres yet";
    EXPECT_EQ(defaultSubsteps(1.0 / 480, 0, 1), 1U);
    EXPECT_EQ(defaultSubsteps(1e-6, 0, 1), 1U);
}

TEST(SceneTiming, SubstepsGrowWithTheRootOfGravityOverRadius) {
    // h = sqrt(8.5e-4 * 0.0125 / 9.81) = 1.0407e-3 s: 16.01 substeps, which the slack rounds to 16.
    EXPECT_EQ(defaultSubsteps(frame, 9.81, 0.0125), 16U);
    EXPECT_EQ(defaultSubsteps(frame, 4 * 9.81, 0.05), 16U);
    EXPECT_EQ(defaultSubsteps(frame, 9.81, 0.005), 26U);  // 25.32
}

TEST(SceneTiming, AbsurdSubstepsDoNotOverflow) {
    EXPECT_EQ(defaultSubsteps(1, 1e30, 1e-6), std::numeric_limits<std::uint32_t>::max());
}

TEST(SceneTiming, GivenSubstepsReplaceTheRule) {
    EXPECT_EQ(sceneWith(R"("substeps": 3)").substeps, 3U);
    EXPECT_EQ(sceneWith(R"("substeps": 3)", {.substeps = 5}).substeps, 5U);
    EXPECT_EQ(sceneWith(group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.5], "radius": 0.0125}]})")).substeps,
              16U);
    EXPECT_EQ(sceneWith(R"("step": 0.1)").substeps, 48U);
}

}  // namespace
}  // namespace spherule::scene::testing
