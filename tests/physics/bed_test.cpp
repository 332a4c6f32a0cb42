#include <gtest/gtest.h>

#include "support.h"

namespace spherule::physics {
namespace {

// A bed of 4,000 spheres in 20 layers, 3 s after the start, with sleep off.
TEST(Bed, HasSmallOverlapsAndSpeeds) {
    const auto simulation = simulate(named("box-4k", {.noSleep = true}));
    run(*simulation, 2.5);
    const double before = simulation->statistics().meanHeight;
    run(*simulation, 0.5);
    const sim::Statistics bed = simulation->statistics();
    EXPECT_LT(bed.overlapMean, 0.015);
    EXPECT_LT(bed.speedRms, 0.04);
    EXPECT_LT((before - bed.meanHeight) / 0.5, 1e-3);
    EXPECT_EQ(bed.outside, 0U);
    EXPECT_EQ(bed.nonFinite, 0U);
    EXPECT_EQ(bed.sleeping, 0U);
    EXPECT_GT(bed.contacts, 8000U);
    RecordProperty("overlapMean", std::to_string(bed.overlapMean));
    RecordProperty("speedRms", std::to_string(bed.speedRms));
    RecordProperty("fallingPerSecond", std::to_string((before - bed.meanHeight) / 0.5));
}

}  // namespace
}  // namespace spherule::physics
