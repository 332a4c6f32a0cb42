#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "support.h"

// Friction and rotation in every model, compared with exact solutions.
namespace spherule::physics {
namespace {

constexpr double tolerance = 0.03;  // relative
constexpr double r = 0.05;

class Friction : public testing::TestWithParam<scene::Model> {
  protected:
    // One sphere on the floor of a wide box, at rest unless given a velocity; `slope` tilts gravity towards +x.
    static scene::Scene onFloor(const scene::Material& material, double slope, glm::vec3 velocity = {}) {
        scene::Scene scene = fineStepBox(8);
        scene.step = 1.0 / 60;
        scene.forces.gravity = earth * glm::dvec3(std::sin(slope), 0, -std::cos(slope));
        scene.materials = {material};
        scene.quality = {.model = GetParam(), .substepsFixed = false, .overlap = 0.3};  // soft, for fewer substeps
        scene.spheres = {{.position = {-2, 0, -4 + r}, .velocity = velocity, .radius = static_cast<float>(r)}};
        if (auto fits = scene::fitSubsteps(scene); !fits) throw std::runtime_error(fits.error().text());
        return scene;
    }
};

// The motion of the only sphere of a scene.
struct Track {
    double travelled = 0;  // along x, m
    double speed = 0;      // along x, m/s, at the end
    double spin = 0;       // about y, rad/s
    double arm = 0;        // distance from the centre to the floor, m: soft spheres overlap it a little
};

Track trackOf(scene::Scene scene, double seconds) {
    const auto simulation = simulate(std::move(scene));
    const double start = positionOf(simulation->snapshot(), 0).x;
    run(*simulation, seconds);
    const sim::State end = simulation->snapshot();
    return {positionOf(end, 0).x - start, velocityOf(end, 0).x, static_cast<double>(end.spin[0].y),
            positionOf(end, 0).z + 4};
}

TEST_P(Friction, TurnsSlidingIntoRolling) {
    constexpr double mu = 0.3;
    constexpr double u = 1;
    const double until = 2 * u / (7 * mu * earth);
    const Track before = trackOf(onFloor({.restitution = 0.1, .friction = mu}, 0, {1, 0, 0}), 0.05);
    EXPECT_NEAR(before.speed, u - mu * earth * 0.05, tolerance * u);
    EXPECT_NEAR(before.spin, 2.5 * mu * earth * 0.05 / r, tolerance * 2.5 * mu * earth * 0.05 / r);
    const Track after = trackOf(onFloor({.restitution = 0.1, .friction = mu}, 0, {1, 0, 0}), 0.5);
    EXPECT_NEAR(after.speed, 5 * u / 7, tolerance * u);
    EXPECT_NEAR(after.spin * after.arm, after.speed, 1e-3);
    const double travelled = 12 * u * u / (49 * mu * earth) + 5 * u / 7 * (0.5 - until);
    EXPECT_NEAR(after.travelled, travelled, tolerance * travelled);
    RecordProperty("speed", std::to_string(after.speed / (5 * u / 7)));
}

TEST_P(Friction, SphereRollsDownASlope) {
    const double slope = 20 * std::numbers::pi / 180;
    const double expected = 5.0 / 7 * earth * std::sin(slope);
    const Track track = trackOf(onFloor({.restitution = 0.1, .friction = 0.3}, slope), 0.5);
    EXPECT_NEAR(track.speed / 0.5, expected, tolerance * expected);
    EXPECT_NEAR(track.travelled, expected / 8, tolerance * expected / 8);
}

TEST_P(Friction, SphereSlidesIfFrictionIsLow) {
    const double slope = 20 * std::numbers::pi / 180;
    const double expected = earth * (std::sin(slope) - 0.05 * std::cos(slope));
    const Track track = trackOf(onFloor({.restitution = 0.1, .friction = 0.05}, slope), 0.5);
    EXPECT_NEAR(track.speed / 0.5, expected, tolerance * expected);
}

TEST_P(Friction, RollingResistanceHoldsASphereOnASlope) {
    const double slope = 20 * std::numbers::pi / 180;  // its tangent is 0.364
    const Track held = trackOf(onFloor({.restitution = 0.1, .friction = 0.5, .rollingResistance = 0.4}, slope), 0.4);
    EXPECT_LT(std::abs(held.travelled), 0.3 * r);
    EXPECT_LT(std::abs(held.speed), 1e-3);
    const scene::Scene steep = onFloor({.restitution = 0.1, .friction = 0.5, .rollingResistance = 0.2}, slope);
    const double gained = trackOf(steep, 0.75).speed - trackOf(steep, 0.25).speed;
    const double expected = 5.0 / 7 * earth * (std::sin(slope) - 0.2 * std::cos(slope));
    EXPECT_NEAR(gained / 0.5, expected, tolerance * expected);
}

// Chung and Ooi 2011, test 4, where the sphere slides: e_t = 1 - mu (1 + e) / tan, spin 5/2 mu (1 + e) v cos / r.
TEST_P(Friction, ObliqueImpactFollowsCoulombsLaw) {
    constexpr double mu = 0.092;
    constexpr double e = 0.98;
    for (const double degrees : {45.0, 60.0, 75.0}) {
        const double angle = degrees * std::numbers::pi / 180;
        scene::Scene scene = fineStepSpace(1);
        scene.bounds.open[scene::ZMin] = false;
        scene.materials = {{.density = 4000, .restitution = e, .friction = mu, .young = 3.8e11, .poisson = 0.23}};
        scene.quality = {.model = GetParam(), .substepsFixed = false};
        scene.step = 1e-4;
        scene.spheres = {
            {.position = {0, 0, -0.4974},
             .velocity = {static_cast<float>(3.9 * std::sin(angle)), 0, static_cast<float>(-3.9 * std::cos(angle))},
             .radius = 0.0025F}};
        ASSERT_TRUE(scene::fitSubsteps(scene));
        const auto simulation = simulate(scene);
        run(*simulation, 0.0004);
        const sim::State end = simulation->snapshot();
        const double expected = 1 - mu * (1 + e) / std::tan(angle);
        EXPECT_NEAR(velocityOf(end, 0).x / (3.9 * std::sin(angle)), expected, 0.016 * expected) << degrees;
        const double spin = 2.5 * mu * (1 + e) * 3.9 * std::cos(angle) / 0.0025;
        EXPECT_NEAR(static_cast<double>(end.spin[0].y), spin, 0.022 * spin) << degrees;
        EXPECT_NEAR(velocityOf(end, 0).z / (3.9 * std::cos(angle)), e, 1e-3);
    }
}

TEST_P(Friction, ConservesMomentumAndAngularMomentum) {
    scene::Scene scene = fineStepSpace(4);
    scene.materials = {{.restitution = 0.6, .friction = 0.4, .rollingResistance = 0.1, .spinningResistance = 0.1},
                       {.name = "heavy", .density = 4000, .friction = 0.6}};
    scene.quality = {.model = GetParam(), .substepsFixed = false};
    scene.step = 1.0 / 480;
    scene.spheres = {{{-0.2, 0.03, 0.02}, {1, 0, 0}, 0.05F, 0, false, 0, {3, 40, -20}},
                     {{0, 0, 0}, {}, 0.07F, 1, false, 0, {0, -10, 9}}};
    ASSERT_TRUE(scene::fitSubsteps(scene));
    const auto simulation = simulate(scene);
    const sim::Statistics before = simulation->statistics();
    run(*simulation, 0.3);
    const sim::Statistics after = simulation->statistics();
    EXPECT_LT(glm::length(after.momentum - before.momentum), 1e-5 * glm::length(before.momentum));
    // The removal of an overlap moves mass across the line of motion. This changes the angular momentum by a share of
    // overlap / arm.
    EXPECT_LT(glm::length(after.angularMomentum - before.angularMomentum), 0.02 * glm::length(before.angularMomentum));
    EXPECT_LT(after.kineticEnergy + after.rotationalEnergy, before.kineticEnergy + before.rotationalEnergy);
}

INSTANTIATE_TEST_SUITE_P(Of, Friction,
                         testing::Values(scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

// A ball on three others, which only friction holds together.
TEST(FrictionInAPile, HoldsATetrahedronOfSoftSpheres) {
    scene::Scene scene = fineStepBox(2);
    scene.step = 1.0 / 60;
    scene.materials = {{.restitution = 0.5, .friction = 0.5}};
    scene.quality = {.model = scene::Model::Accurate, .substepsFixed = false};
    for (int k = 0; k < 3; ++k) {
        const double angle = 2 * std::numbers::pi / 3 * k;
        scene.spheres.push_back(
            {.position =
                 glm::dvec3(0, 0, -0.95) + 0.1 / std::numbers::sqrt3 * glm::dvec3(std::cos(angle), std::sin(angle), 0),
             .radius = static_cast<float>(r)});
    }
    scene.spheres.push_back({.position = {0, 0, -0.95 + 0.1 * std::sqrt(2.0 / 3)}, .radius = static_cast<float>(r)});
    ASSERT_TRUE(scene::fitSubsteps(scene));
    const auto simulation = simulate(scene);
    run(*simulation, 1);
    EXPECT_NEAR(positionOf(simulation->snapshot(), 3).z, scene.spheres[3].position.z, 0.01 * r);
}

// The pile would never rest if springs stored energy without limit, or if dashpots were too strong for the substeps.
TEST(FrictionInAPile, PileOfSoftSpheresComesToRestForAnyRestitution) {
    for (const double e : {0.0, 0.5}) {
        scene::Scene scene = fineStepBox(0.4);
        scene.bounds.max.z = 2;
        scene.step = 1.0 / 60;
        scene.materials = {{.restitution = e, .friction = 0.5, .rollingResistance = 0.05}};
        scene.quality = {.model = scene::Model::Accurate, .substepsFixed = false, .overlap = 0.5};
        for (int k = 0; k < 60; ++k)
            scene.spheres.push_back({.position = {0.12 * (k % 3 - 1) + 0.003 * (k % 7), 0.12 * (k / 3 % 3 - 1),
                                                  -0.14 + 0.11 * static_cast<int>(k / 9)},
                                     .radius = static_cast<float>(r)});
        ASSERT_TRUE(scene::fitSubsteps(scene));
        const auto simulation = simulate(scene);
        run(*simulation, 2);
        const sim::Statistics end = simulation->statistics();
        // Velocities are reported after the forces. A sphere at rest has half of gravity's change in a substep.
        const double half = 0.5 * earth * scene.step / simulation->scene().quality.substeps;
        EXPECT_LT(end.speedRms, 1e-3 + half) << "e = " << e;
        EXPECT_LT(end.rotationalEnergy, 1e-3) << "e = " << e;
        EXPECT_EQ(end.outside, 0U);
    }
}

}  // namespace
}  // namespace spherule::physics
