// The errors of perturbed arithmetic have the size that perturbed_real.h states.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#define SPHERULE_PRECISION of_tests
#include "perturbed_real.h"

namespace spherule::instruments {
namespace {

using compute::cpu::of_tests::Perturbed;

class PerturbedReal : public testing::Test {
  protected:
    PerturbedReal() { perturbation = {.seed = 1}; }
    ~PerturbedReal() override { perturbation = {}; }

    float draw() { return std::ldexp(std::uniform_real_distribution<float>(0.5F, 1)(random_), exponent_(random_)); }

    std::mt19937 random_{5};
    std::uniform_int_distribution<int> exponent_{-20, 20};
};

int ulpsBetween(float exact, Perturbed got) {
    return std::bit_cast<int>(static_cast<float>(got)) - std::bit_cast<int>(exact);
}

TEST_F(PerturbedReal, ErrsByItsLimitsAndNoFurther) {
    std::map<int, int> ofQuotients;
    std::map<int, int> ofProducts;
    std::map<int, int> ofRoots;
    for (int k = 0; k < 10'000; ++k) {
        const float a = draw();
        const float b = draw();
        ++ofQuotients[ulpsBetween(a / b, Perturbed(a) / b)];
        ++ofProducts[ulpsBetween(a * b, Perturbed(a) * b)];
        ++ofRoots[ulpsBetween(std::sqrt(a), sqrt(Perturbed(a)))];
        EXPECT_EQ(static_cast<float>(Perturbed(a) + b), a + b);
        EXPECT_EQ(static_cast<float>(Perturbed(a) * b), static_cast<float>(Perturbed(b) * a));
        EXPECT_EQ(static_cast<float>(Perturbed(-a) * b), -static_cast<float>(Perturbed(b) * a));
        EXPECT_EQ(static_cast<float>(Perturbed(-a) / b), -static_cast<float>(Perturbed(a) / b));
    }
    for (const auto* const found : {&ofQuotients, &ofRoots}) {
        ASSERT_EQ(found->size(), 5U);
        EXPECT_EQ(found->begin()->first, -2);
        for (const auto& [ulps, count] : *found) EXPECT_NEAR(count, 2'000, 200) << ulps;
    }
    ASSERT_EQ(ofProducts.size(), 3U);
    EXPECT_EQ(ofProducts.begin()->first, -1);
    for (const auto& [ulps, count] : ofProducts) EXPECT_NEAR(count, 3'333, 200) << ulps;
}

TEST_F(PerturbedReal, KeepsExactProductsAndSpecialNumbers) {
    for (int k = 0; k < 1'000; ++k) {
        const float a = draw();
        EXPECT_EQ(static_cast<float>(Perturbed(a) * 0.5F), a * 0.5F);
        EXPECT_EQ(static_cast<float>(Perturbed(a) * 0.0F), 0.0F);
    }
    EXPECT_TRUE(std::isinf(static_cast<float>(Perturbed(1.0F) / 0.0F)));
    EXPECT_TRUE(std::isnan(static_cast<float>(Perturbed(0.0F) / 0.0F)));
    EXPECT_EQ(static_cast<float>(sqrt(Perturbed(0.0F))), 0.0F);
    EXPECT_EQ(static_cast<float>(Perturbed(1e-30F) * 1e-10F), 0.0F) << "a denormal";
    EXPECT_EQ(static_cast<float>(Perturbed(1.5e-38F) - 1.4e-38F), 0.0F) << "a denormal";
}

TEST_F(PerturbedReal, DependsOnSeedAndKernel) {
    const auto quotient = [] { return static_cast<float>(Perturbed(1.0F) / 3.0F); };
    std::map<float, int> bySalt;
    for (std::uint32_t seed = 1; seed < 40; ++seed) {
        perturbation.salt = saltOf("kernel", seed);
        const float first = quotient();
        EXPECT_EQ(quotient(), first);
        ++bySalt[first];
    }
    EXPECT_EQ(bySalt.size(), 5U);
    EXPECT_NE(saltOf("one", 1), saltOf("other", 1));
    perturbation = {};
    EXPECT_EQ(quotient(), 1.0F / 3.0F);
}

}  // namespace
}  // namespace spherule::instruments
