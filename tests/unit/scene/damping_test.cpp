#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/stiffness.h"

namespace spherule::scene::testing {
namespace {

// Integrates an impact; returns separation speed / approach speed. `acceleration` depends on the overlap x and its rate
// v. The contact ends when the acceleration would pull.
double restitutionUnder(auto acceleration) {
    constexpr double h = 1e-4;
    double x = 0;
    double v = 1;
    for (int k = 0; k < 1'000'000; ++k) {
        // Runge-Kutta method of the fourth order.
        const std::array<double, 2> a{v, acceleration(x, v)};
        const std::array<double, 2> b{v + 0.5 * h * a[1], acceleration(x + 0.5 * h * a[0], v + 0.5 * h * a[1])};
        const std::array<double, 2> c{v + 0.5 * h * b[1], acceleration(x + 0.5 * h * b[0], v + 0.5 * h * b[1])};
        const std::array<double, 2> d{v + h * c[1], acceleration(x + h * c[0], v + h * c[1])};
        const double nextX = x + h / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0]);
        const double nextV = v + h / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1]);
        if (v < 0 && (nextX <= 0 || acceleration(nextX, nextV) >= 0)) return -nextV;
        x = nextX;
        v = nextV;
    }
    return 0;
}

constexpr std::array restitutions{0.01, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.8, 0.9, 0.99, 1.0};

TEST(SceneDamping, HasItsKnownValues) {
    EXPECT_NEAR(dampingRatio(0.05), 1.94535, 1e-5);
    EXPECT_NEAR(dampingRatio(0.2), 0.731247, 1e-6);
    EXPECT_NEAR(dampingRatio(0.5), 0.255276, 1e-6);
    EXPECT_NEAR(dampingRatio(0.8), 0.074355, 1e-6);
    EXPECT_EQ(dampingRatio(1), 0);
    EXPECT_NEAR(dampingRatio(std::exp(-2.0)), 1, 1e-9) << "critical";
}

TEST(SceneDamping, ReproducesRestitutionWithLinearSprings) {
    for (const double e : restitutions) {
        const double z = dampingRatio(e);
        EXPECT_NEAR(restitutionUnder([z](double x, double v) { return -x - 2 * z * v; }), e, 2e-4) << e;
    }
}

// The dashpot is proportional to the fourth root of the overlap. With the factor sqrt(5), the impact has the same
// restitution as a linear spring and dashpot with the same damping ratio.
TEST(SceneDamping, ReproducesRestitutionUnderHertzsLaw) {
    for (const double e : restitutions) {
        const double z = dampingRatio(e);
        const auto acceleration = [z](double x, double v) {
            const double overlap = std::max(x, 0.0);
            return -std::pow(overlap, 1.5) - std::sqrt(5.0) * z * std::pow(overlap, 0.25) * v;
        };
        EXPECT_NEAR(restitutionUnder(acceleration), e, 2e-4) << e;
    }
}

TEST(SceneDamping, RisesUntilRestitutionIsAThousandth) {
    double above = -1;
    for (double e = 1; e > 0.001; e -= 0.001) {
        EXPECT_GT(dampingRatio(e), above) << e;
        above = dampingRatio(e);
    }
    EXPECT_LE(above, dampingRatio(0));
    EXPECT_EQ(dampingRatio(0), dampingRatio(0.0009));
    const double z = dampingRatio(0);
    EXPECT_NEAR(restitutionUnder([z](double x, double v) { return -x - 2 * z * v; }), 0.001, 2e-5);
}

}  // namespace
}  // namespace spherule::scene::testing
