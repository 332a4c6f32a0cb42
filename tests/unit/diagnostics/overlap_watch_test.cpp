#include "diagnostics/overlap_watch.h"

#include <gtest/gtest.h>

#include <limits>

namespace spherule::diagnostics {
namespace {

TEST(OverlapWatch, ReportsOnceUntilAQuietPeriod) {
    OverlapWatch watch;
    EXPECT_FALSE(watch.check(1, 0.5));
    const auto told = watch.check(2, 0.7);
    ASSERT_TRUE(told);
    EXPECT_EQ(told->find("at step 2, spheres are in each other, or in a wall, by up to 0.7 radii"), 0U) << *told;
    EXPECT_FALSE(watch.check(3, 1.9));
    for (int k = 0; k < 9; ++k) EXPECT_FALSE(watch.check(4, 0.1));
    EXPECT_FALSE(watch.check(5, 0.6)) << "not quiet for long enough";
    for (int k = 0; k < 10; ++k) EXPECT_FALSE(watch.check(6, 0.1));
    EXPECT_TRUE(watch.check(7, 0.6));
}

TEST(OverlapWatch, IgnoresNaN) {
    EXPECT_FALSE(OverlapWatch().check(1, std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace spherule::diagnostics
