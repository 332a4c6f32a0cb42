#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "kernels_bed.h"

namespace spherule::kernels {
namespace {

void separate(Bed& bed) {
    bed.sweep("solve_positions");
}

TEST(KernelsAsCpp, PairsWithinTheMarginAreListedOnce) {
    // 0 and 1 overlap; 1 and 2 are half a margin apart; 3 is alone; 0 and 4 are near across a cell border below the
    // origin.
    Bed bed({vec4(0.1F, 0, 0, 0.5F), vec4(1.0F, 0, 0, 0.5F), vec4(2.05F, 0, 0, 0.5F), vec4(0, 5, 0, 0.5F),
             vec4(-0.8F, 0, 0, 0.5F)});
    bed.rebuild();
    EXPECT_EQ(bed.counters[COUNTER_PAIRS], 3U);
    EXPECT_EQ(bed.counters[COUNTER_UNLISTED], 0U);
}

TEST(KernelsAsCpp, OverlapIsRemovedInProportionToInverseMass) {
    Bed bed({vec4(0, 0, 0, 0.5F), vec4(0.9F, 0, 0, 0.5F)});
    bed.velocity[1].w = 3;  // inverse mass
    bed.rebuild();
    separate(bed);
    EXPECT_NEAR(bed.at(0).x, -0.025F, 1e-6F);
    EXPECT_NEAR(bed.at(1).x, 0.975F, 1e-6F);
    EXPECT_NEAR(bed.velocityOf(0).x, -0.025F * 480, 1e-3F);
    EXPECT_NEAR(bed.velocityOf(1).x, 0.075F * 480, 1e-3F);
    EXPECT_NEAR(bed.momentum().x, 0, 1e-5F);
}

TEST(KernelsAsCpp, OnlyOverlappingPairsHaveContactsAndImpulses) {
    Bed bed({vec4(0, 0, 0, 0.5F), vec4(0.9F, 0, 0, 0.5F), vec4(1.95F, 0, 0, 0.5F)}, Feature::FRICTION);
    bed.rebuild();
    ASSERT_EQ(bed.listed().size(), 2U);
    separate(bed);
    const std::vector<uint> touching = bed.inTouch();
    ASSERT_EQ(touching.size(), 1U);
    EXPECT_EQ(bed.idsInTouch(touching[0]), uvec2(0, 1));
    EXPECT_NEAR(bed.normalImpulses[touching[0]], 0.05F * 480, 1e-3F);
}

TEST(KernelsAsCpp, UnlistedPairsAreAlsoSeparated) {
    Bed bed({vec4(0, 0, 0, 0.5F), vec4(0.9F, 0, 0, 0.5F)});
    bed.parameters.pairCapacity = 0;
    bed.rebuild();
    EXPECT_EQ(bed.counters[COUNTER_UNLISTED], 1U);
    separate(bed);
    EXPECT_NEAR(glm::distance(bed.at(0), bed.at(1)), 1.0F, 1e-6F);
}

}  // namespace
}  // namespace spherule::kernels
