// Springs that pull every sphere to a point, in each model.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "field_support.h"
#include "scene/quality.h"

namespace spherule::physics {
namespace {

constexpr double pi = std::numbers::pi;

class FieldSprings : public testing::TestWithParam<scene::Model> {};

scene::Scene onSpring(scene::Model model, const scene::Spring& spring, const glm::dvec3& stretch) {
    scene::Scene scene = oneSphere(model, spring.centre + stretch, {});
    scene.forces.fields = {spring};
    return scene;
}

// Up to 0.2 rad in a substep, the largest that scenes may have.
TEST_P(FieldSprings, PeriodFollowsStiffnessAndMass) {
    scene::Random random(1);
    for (const double rate : {1.0, 5.0, 20.0, 60.0, 0.2 * 480}) {  // rad/s
        const scene::Spring spring{randomDirection(random), rate * rate * fieldMass};
        const glm::dvec3 way = randomDirection(random);
        const double stretch = std::min(0.5, 2 / rate);  // m: slow enough for the substeps
        const auto simulation = simulate(onSpring(GetParam(), spring, stretch * way));
        const double h = simulation->scene().step;
        double before = stretch;
        double first = 0;
        double last = 0;
        double farthest = 0;
        int crossings = 0;
        for (double time = h; crossings < 11; time += h) {
            run(*simulation, h);
            const double now = glm::dot(placeOf(*simulation) - spring.centre, way);
            farthest = std::max(farthest, std::abs(now));
            if (before > 0 && now <= 0) {
                last = time - h * now / (now - before);
                if (crossings++ == 0) first = last;
            }
            before = now;
            ASSERT_LT(time, 100 / rate);
        }
        EXPECT_NEAR((last - first) / 10 * rate / (2 * pi), 1, 2.5e-3) << rate;
        EXPECT_NEAR(farthest, stretch, 0.01 * stretch);
    }
}

// x = A exp(-b t) (cos(w t) + b / w sin(w t)), with 2 b = damping / m and w^2 = k / m - b^2.
TEST_P(FieldSprings, DampedSwingsDecayByTheirLaw) {
    for (const double damped : {0.02, 0.1, 0.5}) {
        constexpr double rate = 6;  // rad/s
        const double b = damped * rate;
        const scene::Spring spring{{1, 2, -1}, rate * rate * fieldMass, 2 * b * fieldMass};
        const auto simulation = simulate(onSpring(GetParam(), spring, {0.4, 0, 0}));
        const double w = std::sqrt(rate * rate - b * b);
        for (int k = 1; k <= 20; ++k) {
            run(*simulation, 0.1);
            const double t = 0.1 * k;
            const double expected = 0.4 * std::exp(-b * t) * (std::cos(w * t) + b / w * std::sin(w * t));
            EXPECT_NEAR(placeOf(*simulation).x - 1, expected, 0.4 * 8e-3) << damped << " after " << t << " s";
        }
    }
}

// The damping is implicit: it may be as strong as it likes.
TEST_P(FieldSprings, StrongDampingCreepsToTheCentre) {
    const scene::Spring spring{{}, 100 * fieldMass, 1e4 * fieldMass};
    const auto simulation = simulate(onSpring(GetParam(), spring, {0.4, 0, 0}));
    double before = 0.4;
    for (int k = 0; k < 20; ++k) {
        run(*simulation, 1);
        const double now = placeOf(*simulation).x;
        EXPECT_LT(now, before);
        EXPECT_GT(now, 0);
        before = now;
    }
    EXPECT_NEAR(before, 0.4 * std::exp(-0.01 * 20), 2e-3);
}

TEST_P(FieldSprings, EnergyAndAngularMomentumStay) {
    scene::Random random(2);
    for (int k = 0; k < 5; ++k) {
        const scene::Spring spring{randomDirection(random), random.uniform(1, 50)};
        scene::Scene scene = onSpring(GetParam(), spring, randomDirection(random));
        scene.spheres[0].velocity = glm::vec3(random.uniform(0, 4) * randomDirection(random));
        const auto simulation = simulate(scene);
        const auto spin = [&] { return glm::cross(placeOf(*simulation) - spring.centre, speedOf(*simulation)); };
        const double energy = energyOf(*simulation);
        EXPECT_NEAR(energy,
                    0.5 * fieldMass * glm::dot(speedOf(*simulation), speedOf(*simulation)) + 0.5 * spring.stiffness,
                    1e-5 * energy);
        const glm::dvec3 turning = spin();
        for (int second = 0; second < 10; ++second) {
            run(*simulation, 1);
            EXPECT_NEAR(energyOf(*simulation), energy, 3e-3 * energy);
            EXPECT_LT(glm::distance(spin(), turning), 1e-4 * (1 + glm::length(turning)));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Of, FieldSprings, testing::ValuesIn(fieldModels),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

}  // namespace
}  // namespace spherule::physics
