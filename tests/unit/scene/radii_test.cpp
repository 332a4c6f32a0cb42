#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scene/check.h"
#include "scene/radius_distribution.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

constexpr int draws = 200'000;

RadiusDistribution distribution(const std::string& radius) {
    const v1::Scene scene = parsed(object(group(R"("radius": )" + radius)));
    Check check;
    RadiusDistribution result = readRadiusDistribution(check, scene.groups(0).radius(), "radius");
    EXPECT_TRUE(check.ok()) << check.error().value().message;
    return result;
}

std::string refusal(const std::string& radius) {
    return refusalOf(group(R"("list": {}, "radius": )" + radius));
}

// Returns the share of `draws` radii for which `counts` is true.
template <class Counts>
double shareOf(const RadiusDistribution& radii, std::uint64_t seed, Counts counts) {
    Random random(seed);
    int counted = 0;
    for (int i = 0; i < draws; ++i) counted += counts(static_cast<double>(radii.draw(random))) ? 1 : 0;
    return static_cast<double>(counted) / draws;
}

double normalShareBelow(double deviations) {
    return 0.5 * std::erfc(-deviations / std::sqrt(2.0));
}

TEST(PortableExp, IsWithinItsErrorOfTheLibrary) {
    Random random(3);
    double largest = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        const double range = i % 2 == 0 ? 700 : 1;
        const double x = random.uniform(-range, range);
        largest = std::max(largest, std::abs(portableExp(x) / std::exp(x) - 1));
    }
    EXPECT_LT(largest, 6e-16);  // of both
    EXPECT_EQ(portableExp(0), 1);
    EXPECT_TRUE(std::isfinite(portableExp(700)));
    EXPECT_GT(portableExp(-700), 0);
}

TEST(SceneRadii, StayWithinTheirLimits) {
    const RadiusDistribution uniform{.min = 0.1, .max = 0.2, .kind = {}};
    const RadiusDistribution normal{.min = 0.1, .max = 0.2, .kind = RadiusDistribution::Normal{0.12, 0.02}};
    Random random(7);
    double uniformSum = 0;
    double normalSum = 0;
    for (int i = 0; i < draws; ++i) {
        const float u = uniform.draw(random);
        const float n = normal.draw(random);
        ASSERT_GE(std::min(u, n), 0.1F);
        ASSERT_LE(std::max(u, n), 0.2F);
        uniformSum += static_cast<double>(u);
        normalSum += static_cast<double>(n);
    }
    EXPECT_NEAR(uniformSum / draws, 0.15, 0.0005);
    // Mean of a normal distribution that is cut at -1 and +4 standard deviations: 0.12 + 0.02 phi(1) / Phi(1).
    EXPECT_NEAR(normalSum / draws, 0.12 + 0.02 * 0.24197 / 0.84134, 0.0005);
}

// The mean cube is the one of many draws, within five standard errors of these.
TEST(SceneRadii, MeanCubeIsThatOfTheDraws) {
    const std::vector<std::string> all = {
        R"({"constant": 0.2})",
        R"({"uniform": {"min": 0.1, "max": 0.3}})",
        R"({"uniform": {"min": 1e-6, "max": 1}})",
        R"({"normal": {"mean": 0.2, "deviation": 0.02, "min": 0.1, "max": 0.3}})",
        R"({"normal": {"mean": 0.11, "deviation": 0.19, "min": 0.1, "max": 0.3}})",
        R"({"normal": {"mean": 0.5, "deviation": 1e-6, "min": 0.1, "max": 0.9}})",
        R"({"logNormal": {"median": 0.01, "deviation": 0.3, "min": 0.001, "max": 0.1}})",
        R"({"logNormal": {"median": 0.01, "deviation": 1.2, "min": 0.001, "max": 0.1}})",
        R"({"logNormal": {"median": 0.01, "deviation": 4, "min": 0.001, "max": 0.1}})",
        R"({"table": {"radii": [0.1, 0.2, 0.4], "shares": [0, 0.7, 1]}})",
        R"({"table": {"radii": [0.1, 0.2, 0.4], "shares": [0, 0.7, 1], "byMass": true}})",
        R"({"table": {"radii": [0.01, 0.1, 0.2], "shares": [0, 0.5, 1], "byMass": true}})",
    };
    for (const std::string& one : all) {
        const RadiusDistribution radii = distribution(one);
        Random random(11);
        double sum = 0;
        double squares = 0;
        for (int k = 0; k < draws; ++k) {
            const double r = static_cast<double>(radii.draw(random));
            sum += r * r * r;
            squares += r * r * r * r * r * r;
        }
        const double mean = sum / draws;
        const double error = std::sqrt(std::max(0.0, squares / draws - mean * mean) / draws);
        EXPECT_NEAR(radii.meanCube(), mean, 5 * error + 1e-6 * mean) << one;
        EXPECT_LT(error, 0.05 * mean) << "the draws tell little, " << one;
    }
}

// Limits far from the mean do not change it.
TEST(SceneRadii, MeanCubeFollowsTheLaw) {
    const double normal =
        distribution(R"({"normal": {"mean": 0.5, "deviation": 0.03, "min": 0.1, "max": 0.9}})").meanCube();
    EXPECT_NEAR(normal, 0.5 * 0.5 * 0.5 + 3 * 0.5 * 0.03 * 0.03, 1e-9);
    const double logNormal =
        distribution(R"({"logNormal": {"median": 0.01, "deviation": 0.5, "min": 1e-5, "max": 10}})").meanCube();
    EXPECT_NEAR(logNormal * 1e6, std::exp(4.5 * 0.5 * 0.5), 1e-6);
}

TEST(SceneRadii, ConstantRadiusUsesNoRandomNumbers) {
    Random random(8);
    const RadiusDistribution constant{.min = 0.1, .max = 0.1, .kind = {}};
    EXPECT_EQ(constant.draw(random), 0.1F);
    EXPECT_EQ(random.uniform(), Random(8).uniform());
}

TEST(SceneRadii, LogNormalIsTheSameOnAllPlatforms) {
    Random random(1);
    const RadiusDistribution radii = distribution(R"({"logNormal": {"median": 0.1, "deviation": 0.5, "min": 0.01,
        "max": 1}})");
    EXPECT_EQ(radii.draw(random), static_cast<float>(0.1 * portableExp(0.5 * Random(1).normal())));
    EXPECT_FLOAT_EQ(radii.draw(random), 0.10449458F);
}

TEST(SceneRadii, LogNormalHasItsMedianAndDeviation) {
    const RadiusDistribution radii = distribution(R"({"logNormal": {"median": 0.1, "deviation": 0.5, "min": 0.001,
        "max": 10}})");
    for (const double deviations : {-2.0, -1.0, 0.0, 0.5, 1.5}) {
        const double radius = 0.1 * std::exp(0.5 * deviations);
        EXPECT_NEAR(shareOf(radii, 11, [&](double r) { return r <= radius; }), normalShareBelow(deviations), 0.004);
    }
}

TEST(SceneRadii, LogNormalIsCutAtItsLimits) {
    const RadiusDistribution radii = distribution(R"({"logNormal": {"median": 0.1, "deviation": 0.6, "min": 0.1,
        "max": 0.2}})");
    EXPECT_EQ(shareOf(radii, 12, [](double r) { return r < 0.0999999 || r > 0.2000001; }), 0);
    const double whole = normalShareBelow(std::log(2.0) / 0.6) - 0.5;
    const double part = normalShareBelow(std::log(1.4) / 0.6) - 0.5;
    EXPECT_NEAR(shareOf(radii, 13, [](double r) { return r <= 0.14; }), part / whole, 0.004);
}

TEST(SceneRadii, LogNormalIsRefusedIfTooFewDrawsAreWithinItsLimits) {
    const auto logNormal = [](const std::string& members) { return refusal(R"({"logNormal": {)" + members + "}}"); };
    EXPECT_EQ(logNormal(R"("median": 0.3, "deviation": 0.1, "min": 0.1, "max": 0.2)"),
              "groups[0].radius.logNormal.median: is 0.3, must be 0.1 to 0.2 (min to max)");
    EXPECT_EQ(
        logNormal(R"("median": 1, "deviation": 3, "min": 1, "max": 10)"),
        "groups[0].radius.logNormal.deviation: is 3, must be at most 2.302585092994046 (ln(max / min); for a wider "
        "one use a table)");
    EXPECT_EQ(logNormal(R"("median": 0.1, "deviation": 0, "min": 0.1, "max": 0.2)"),
              "groups[0].radius.logNormal.deviation: is 0, must be positive");
    EXPECT_EQ(logNormal(R"("median": 0.1, "deviation": 0.1, "min": 0.2, "max": 0.1)"),
              "groups[0].radius.logNormal.max: is 0.1, must be above min, 0.2");
    EXPECT_EQ(logNormal(R"("median": 0.1, "deviation": 0.1, "max": 0.1)"),
              "groups[0].radius.logNormal.min: is 0, must be positive");
    EXPECT_EQ(logNormal(R"("median": 1, "deviation": 27, "min": 1e-6, "max": 1e6)"), "accepted");
}

TEST(SceneRadii, TableHasItsSharesOfTheNumber) {
    const RadiusDistribution radii =
        distribution(R"({"table": {"radii": [0.1, 0.2, 0.3, 0.6], "shares": [0, 0.5, 0.5, 1]}})");
    EXPECT_EQ(radii.min, 0.1);
    EXPECT_EQ(radii.max, 0.6);
    const std::vector<std::pair<double, double>> curve{{0.1, 0},    {0.15, 0.25}, {0.2, 0.5},
                                                       {0.29, 0.5}, {0.45, 0.75}, {0.6001, 1}};
    for (const auto& [radius, share] : curve)
        EXPECT_NEAR(shareOf(radii, 14, [&](double r) { return r < radius; }), share, 0.004) << radius;
}

// Random curves by mass: the mass of the drawn spheres follows the curve.
TEST(SceneRadii, TableHasItsSharesOfTheMass) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        const auto points = static_cast<std::size_t>(random.uniform(2, 8));
        std::vector<double> radii{random.uniform(0.001, 1)};
        std::vector<double> shares{0};
        for (std::size_t i = 1; i < points; ++i) {
            radii.push_back(radii.back() * random.uniform(1.01, 1.6));
            shares.push_back(shares.back() + random.uniform());
        }
        for (double& share : shares) share /= shares.back();
        const SieveCurve curve(SieveCurve::Of::Mass, radii, shares);
        std::vector<double> masses(points);  // between a radius and the one before; of radius 0: 0
        double sum = 0;
        for (int i = 0; i < draws; ++i) {
            const double r = curve.draw(random);
            ASSERT_GE(r, radii.front());
            ASSERT_LE(r, radii.back());
            const auto k = static_cast<std::size_t>(std::ranges::lower_bound(radii, r) - radii.begin());
            masses[k] += r * r * r;
            sum += r * r * r;
        }
        double below = 0;
        for (std::size_t k = 0; k < points; ++k) {
            below += masses[k];
            EXPECT_NEAR(below / sum, shares[k], 0.03) << "seed " << seed << ", point " << k;
        }
    }
}

TEST(SceneRadii, TableIsLinearInMassBetweenItsRadii) {
    const SieveCurve curve(SieveCurve::Of::Mass, {1, 2}, {0, 1});
    Random random(15);
    double below = 0;
    double sum = 0;
    for (int i = 0; i < draws; ++i) {
        const double r = curve.draw(random);
        sum += r * r * r;
        if (r <= 1.25) below += r * r * r;
    }
    EXPECT_NEAR(below / sum, 0.25, 0.004);
}

TEST(SceneRadii, TableOfAllRadiiAllowedIsDrawn) {
    for (const char* byMass : {"false", "true"}) {
        const RadiusDistribution radii = distribution(
            std::string(R"({"table": {"radii": [1e-6, 1e6], "shares": [0, 1], "byMass": )") + byMass + "}}");
        EXPECT_EQ(shareOf(radii, 16, [](double r) { return r >= 0.999999e-6 && r <= 1e6; }), 1) << byMass;
    }
}

TEST(SceneRadii, TableIsRefusedIfItIsNoCurve) {
    const auto table = [](const std::string& radii, const std::string& shares) {
        return refusal(R"({"table": {"radii": [)" + radii + R"(], "shares": [)" + shares + "]}}");
    };
    const std::string at = "groups[0].radius.table.";
    EXPECT_EQ(table("0.1", "1"), at + "radii: has 1 numbers, must have 2 to 64");
    EXPECT_EQ(table("0.1, 0.2", "1"), at + "shares: has 1 numbers, must have one for each of the 2 radii");
    EXPECT_EQ(table("0.2, 0.2", "0, 1"), at + "radii[1]: is 0.2, must be above the radius before it, 0.2");
    EXPECT_EQ(table("0, 0.2", "0, 1"), at + "radii[0]: is 0, must be positive");
    EXPECT_EQ(table("0.1, 0.2, 0.3", "0, 0.5, 0.4"),
              at + "shares[2]: is 0.4, must be at least the share before it, 0.5");
    EXPECT_EQ(table("0.1, 0.2", "0, 100"), at + "shares[1]: is 100, must be 0 to 1");
    EXPECT_EQ(table("0.1, 0.2", "0.1, 1"), at + "shares[0]: is 0.1, must be 0: no sphere is smaller than the first "
                                                "radius; begin with the smallest radius");
    EXPECT_EQ(table("0.1, 0.2", "0, 0.9"), at + "shares[1]: is 0.9, must be 1: no sphere is larger than the last "
                                                "radius; end with the largest radius");
    std::string radii = "1";
    std::string shares = "0";
    for (int i = 2; i <= 65; ++i) {
        radii += ", " + std::to_string(i);
        shares += ", 1";
        const std::string result = table(radii, shares);
        EXPECT_EQ(result == "accepted", i <= 64) << result;
    }
    EXPECT_EQ(table(radii, shares), at + "radii: has 65 numbers, must have 2 to 64");
}

}  // namespace
}  // namespace spherule::scene::testing
