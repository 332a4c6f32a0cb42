#include <gtest/gtest.h>

#include "support.h"

namespace spherule::physics {
namespace {

// A bed of 4,000 spheres in 20 layers, 2.5 to 4.5 s after the start, with sleep off. The whole bed breathes: in half a
// second a single one rises by 0.1 mm or sinks by 1 mm.
TEST(Bed, HasSmallOverlapsAndSpeeds) {
    constexpr int beds = 4;
    double falling = 0;  // m/s
    for (std::uint64_t seed = 1; seed <= beds; ++seed) {
        SCOPED_TRACE(seed);
        const auto simulation = simulate(named("box-4k", {.seed = seed, .noSleep = true}));
        run(*simulation, 2.5);
        const double before = simulation->statistics().meanHeight;
        run(*simulation, 2);
        const sim::Statistics bed = simulation->statistics();
        EXPECT_LT(bed.overlapMean, 0.015);
        EXPECT_LT(bed.speedRms, 0.04);
        EXPECT_EQ(bed.outside, 0U);
        EXPECT_EQ(bed.nonFinite, 0U);
        EXPECT_EQ(bed.sleeping, 0U);
        EXPECT_GT(bed.contacts, 8000U);
        falling += (before - bed.meanHeight) / 2 / beds;
        RecordProperty("overlapMeanSeed" + std::to_string(seed), std::to_string(bed.overlapMean));
        RecordProperty("speedRmsSeed" + std::to_string(seed), std::to_string(bed.speedRms));
    }
    EXPECT_LT(falling, 1e-3);
    RecordProperty("fallingPerSecond", std::to_string(falling));
}

}  // namespace
}  // namespace spherule::physics
