#include "diagnostics/auto_quality.h"

#include <gtest/gtest.h>

namespace spherule::diagnostics {
namespace {

using scene::QualityGoal;

constexpr scene::SubstepRange range{.fewest = 2, .most = 64};

// A model of a world: the step time is proportional to the substeps, the overlap to the inverse of their square.
struct World {
    AutoQuality quality;
    double msPerSubstep = 1;
    double overlapOfOne = 1;
    std::uint32_t substeps = 8;
    int changes = 0;
    std::string said{};

    void read(int times, std::uint64_t contacts = 100) {
        for (int k = 0; k < times; ++k) {
            const Reading reading{.stepMs = msPerSubstep * substeps,
                                  .contacts = contacts,
                                  .overlapMean = overlapOfOne / (1.0 * substeps * substeps)};
            const auto decision = quality.take(reading, substeps);
            if (!decision) continue;
            changes += decision->substeps != substeps;
            substeps = decision->substeps;
            said += decision->text + "\n";
        }
    }
};

World holding(QualityGoal::Kind kind, double most) {
    return {.quality = AutoQuality({kind, most}, range)};
}

TEST(AutoQuality, LowersSubstepsToMeetTheBudget) {
    World world = holding(QualityGoal::Kind::StepTime, 10);
    world.msPerSubstep = 4;
    world.read(40);
    EXPECT_EQ(world.substeps, 2U);
    EXPECT_NE(world.said.find("4 substeps per step in place of 8: a step takes 32 ms, and may take 10"),
              std::string::npos)
        << world.said;
}

TEST(AutoQuality, IgnoresSingleSlowReadings) {
    World world = holding(QualityGoal::Kind::StepTime, 10);
    for (int k = 0; k < 20; ++k) {
        world.msPerSubstep = 5;
        world.read(1);
        world.msPerSubstep = 1;
        world.read(1);
    }
    EXPECT_EQ(world.changes, 0) << world.said;
}

TEST(AutoQuality, RaisesSubstepsWithinTheBudgetAndThenStaysConstant) {
    World world = holding(QualityGoal::Kind::StepTime, 40);
    world.read(100);
    EXPECT_LE(world.substeps, 40U);
    EXPECT_GE(world.substeps, 24U);
    const int before = world.changes;
    world.read(100);
    EXPECT_EQ(world.changes, before) << "it does not go up and down";
}

TEST(AutoQuality, ReportsAnUnreachableBudgetOnce) {
    World world = holding(QualityGoal::Kind::StepTime, 1);
    world.read(100);
    EXPECT_EQ(world.substeps, 2U);
    const std::string told =
        "the goal is out of reach even with 2 substeps per step: a step takes 2 ms, and may take 1";
    const auto first = world.said.find(told);
    ASSERT_NE(first, std::string::npos) << world.said;
    EXPECT_EQ(world.said.find("out of reach", first + told.size()), std::string::npos) << world.said;
}

TEST(AutoQuality, RaisesSubstepsToMeetTheOverlap) {
    World world = holding(QualityGoal::Kind::Overlap, 0.005);
    world.read(100);
    EXPECT_LE(1 / (1.0 * world.substeps * world.substeps), 0.005);
    EXPECT_LE(world.substeps, 23U) << "but not much further";
}

TEST(AutoQuality, LowersSubstepsIfTheOverlapIsFarBelowTheGoal) {
    World world = holding(QualityGoal::Kind::Overlap, 0.05);
    world.substeps = 60;
    world.read(200);
    EXPECT_LE(1 / (1.0 * world.substeps * world.substeps), 0.05);
    EXPECT_LT(world.substeps, 9U);
}

TEST(AutoQuality, IgnoresOverlapsWithoutContacts) {
    World world = holding(QualityGoal::Kind::Overlap, 0.005);
    world.read(100, 0);
    EXPECT_EQ(world.changes, 0);
}

TEST(AutoQuality, StaysInItsRange) {
    World world = holding(QualityGoal::Kind::Overlap, 1e-6);
    world.read(100);
    EXPECT_EQ(world.substeps, 64U);
    EXPECT_NE(world.said.find("out of reach even with 64 substeps"), std::string::npos) << world.said;
    // More substeps than the range allows, as a user may set: they are not reduced while the overlap is too large.
    world.substeps = 100;
    world.read(20);
    EXPECT_EQ(world.substeps, 100U);
}

}  // namespace
}  // namespace spherule::diagnostics
