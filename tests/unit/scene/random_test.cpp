#include <gtest/gtest.h>

#include <cmath>

#include "scene/random.h"

namespace spherule::scene::testing {
namespace {

constexpr int draws = 200'000;

TEST(SceneRandom, IsTheSameOnAllPlatforms) {
    // The C++ standard (mt19937_64) and IEEE 754 determine these values. Other values would change all scenes with a
    // seed.
    Random random(1);
    EXPECT_EQ(random.uniform(), Random(1).uniform());
    EXPECT_NE(random.uniform(), Random(2).uniform());
    EXPECT_NE(Random(1, 0).uniform(), Random(1, 1).uniform());
    EXPECT_DOUBLE_EQ(Random(1).uniform(), 0.44149167444625148);
    EXPECT_DOUBLE_EQ(Random(1).normal(), 0.96852829754777836);
}

TEST(SceneRandom, UniformCoversItsRange) {
    Random random(5);
    double sum = 0;
    double low = 9;
    double high = 0;
    for (int i = 0; i < draws; ++i) {
        const double value = random.uniform(2, 4);
        sum += value;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    EXPECT_NEAR(sum / draws, 3, 0.005);
    EXPECT_GE(low, 2);
    EXPECT_LT(low, 2.001);
    EXPECT_LT(high, 4);
    EXPECT_GT(high, 3.999);
}

TEST(SceneRandom, NormalHasItsMomentsAndTails) {
    Random random(6);
    double sum = 0;
    double squares = 0;
    double fourths = 0;
    int beyondTwo = 0;
    for (int i = 0; i < draws; ++i) {
        const double value = random.normal();
        sum += value;
        squares += value * value;
        fourths += value * value * value * value;
        if (std::abs(value) > 2) ++beyondTwo;
    }
    EXPECT_NEAR(sum / draws, 0, 0.01);
    EXPECT_NEAR(squares / draws, 1, 0.015);
    EXPECT_NEAR(fourths / draws, 3, 0.1);
    EXPECT_NEAR(static_cast<double>(beyondTwo) / draws, std::erfc(std::sqrt(2.0)), 0.0015);
}

}  // namespace
}  // namespace spherule::scene::testing
