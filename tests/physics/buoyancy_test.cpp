// Spheres in liquids, in each model, against the volume of a spherical cap.
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

class Liquids : public testing::TestWithParam<scene::Model> {};

// A sphere whose centre is `depth` below the surface of a liquid with this density over the sphere's.
scene::Scene floating(scene::Model model, double ratio, const glm::dvec3& gravity, const glm::dvec3& surface,
                      double depth) {
    scene::Scene scene = oneSphere(model, surface + depth * glm::normalize(gravity), {});
    scene.forces = {.gravity = gravity, .fields = {scene::Buoyancy{.density = 1000 * ratio, .surface = surface}}};
    return scene;
}

double depthNow(sim::Simulation& simulation, const glm::dvec3& surface) {
    return glm::dot(placeOf(simulation) - surface, glm::normalize(simulation.scene().forces.gravity));
}

// A damped sphere comes to rest where the liquid that it displaces weighs as much.
TEST_P(Liquids, SpheresFloatAtTheDepthOfTheirWeight) {
    scene::Random random(1);
    for (int k = 0; k < 8; ++k) {
        const double share = random.uniform(0.1, 0.9);
        const glm::dvec3 gravity = random.uniform(3, 15) * randomDirection(random);
        const glm::dvec3 surface = 2.0 * randomDirection(random);
        scene::Scene scene = floating(GetParam(), 1 / share, gravity, surface, random.uniform(-0.06, 0.1));
        scene.forces.fields.emplace_back(scene::Spring{.damping = 5});
        const auto simulation = simulate(scene);
        run(*simulation, 3);
        EXPECT_NEAR(depthNow(*simulation, surface), depthWithShare(share), 2e-3 * fieldRadius) << share;
        EXPECT_LT(glm::length(speedOf(*simulation)), 1e-4);
    }
}

// omega^2 = rho g A / m, with the section A of the sphere with the surface.
TEST_P(Liquids, SmallBobbingHasThePeriodOfItsSection) {
    scene::Random random(2);
    for (const double share : {0.25, 0.5, 0.7}) {
        const double depth = depthWithShare(share);
        const glm::dvec3 gravity = 9.0 * randomDirection(random);
        const auto simulation = simulate(floating(GetParam(), 1 / share, gravity, {}, depth + 0.02 * fieldRadius));
        const double section = pi * (fieldRadius * fieldRadius - depth * depth);
        const double period = 2 * pi / std::sqrt(1000 / share * 9.0 * section / fieldMass);
        double before = 1;
        double first = 0;
        double last = 0;
        int crossings = 0;
        const double h = simulation->scene().step;
        for (double time = h; crossings < 21; time += h) {
            run(*simulation, h);
            const double now = depthNow(*simulation, {}) - depth;
            if (before > 0 && now <= 0) {
                last = time - h * now / (now - before);
                if (crossings++ == 0) first = last;
            }
            before = now;
            ASSERT_LT(time, 40 * period);
        }
        EXPECT_NEAR((last - first) / 20, period, 2e-3 * period) << share;
    }
}

// The sphere leaves the liquid and dives below the surface, for a minute. Its motion along the surface does not change.
TEST_P(Liquids, EnergyStaysInAMinuteOfBobbing) {
    scene::Random random(3);
    const glm::dvec3 gravity = 9.0 * randomDirection(random);
    scene::Scene scene = floating(GetParam(), 2, gravity, {}, 3 * fieldRadius);
    const glm::dvec3 aside = 0.1 * glm::normalize(glm::cross(gravity, randomDirection(random)));
    scene.spheres[0].velocity = glm::vec3(aside);
    const auto simulation = simulate(scene);
    const double before = energyOf(*simulation);
    double lowest = 1;
    double highest = -1;
    for (int k = 0; k < 600; ++k) {
        run(*simulation, 0.1);
        EXPECT_NEAR(energyOf(*simulation), before, 2e-3 * fieldMass * 9 * fieldRadius) << k;
        lowest = std::min(lowest, depthNow(*simulation, {}));
        highest = std::max(highest, depthNow(*simulation, {}));
        const glm::dvec3 v = speedOf(*simulation);
        const glm::dvec3 along = v - gravity * (glm::dot(v, gravity) / 81);
        EXPECT_LT(glm::distance(along, aside), 1e-4);
    }
    EXPECT_LT(lowest, -fieldRadius);
    EXPECT_GT(highest, 2.9 * fieldRadius);
    EXPECT_LT(highest, 3.1 * fieldRadius);
}

TEST_P(Liquids, WithoutASurfaceALiquidIsEverywhere) {
    scene::Random random(4);
    for (const double ratio : {0.3, 1.0, 2.5}) {
        const glm::dvec3 gravity = 6.0 * randomDirection(random);
        scene::Scene scene = oneSphere(GetParam(), {}, {});
        scene.forces = {.gravity = gravity, .fields = {scene::Buoyancy{.density = 1000 * ratio}}};
        const auto simulation = simulate(scene);
        const double before = energyOf(*simulation);
        run(*simulation, 1);
        EXPECT_LT(glm::distance(speedOf(*simulation), gravity * (1 - ratio)), 1e-4);
        EXPECT_NEAR(energyOf(*simulation), before, 1e-5 * fieldMass * 6 * 10);
    }
}

// The energy that statistics show for spheres at rest: the work of the force from above the surface to the place.
TEST_P(Liquids, StatisticsShowTheWorkAgainstBuoyancy) {
    scene::Random random(5);
    for (int k = 0; k < 10; ++k) {
        const glm::dvec3 gravity = 9.0 * randomDirection(random);
        const double depth = random.uniform(-0.06, 0.2);
        const double ratio = random.uniform(0.2, 3);
        scene::Scene scene = floating(GetParam(), ratio, gravity, {}, depth);
        const scene::Buoyancy liquid = std::get<scene::Buoyancy>(scene.forces.fields[0]);
        const auto simulation = simulate(scene);
        double work = 0;
        constexpr int parts = 2000;
        const double way = depth + 2 * fieldRadius;
        for (int part = 0; part < parts; ++part) {
            const double at = -2 * fieldRadius + (part + 0.5) * way / parts;
            work += way / parts * glm::length(buoyancyForce(liquid, gravity, glm::normalize(gravity) * at));
        }
        EXPECT_NEAR(simulation->statistics().fieldEnergy, work, 1e-5 * ratio * fieldMass * 9 * 0.3);
    }
}

// A command turns gravity: the surface turns about its point, and the sphere rises to it from another side.
TEST_P(Liquids, SurfacesFollowGravity) {
    scene::Scene scene = floating(GetParam(), 2, {0, 0, -9}, {}, -0.2);
    scene.forces.fields.emplace_back(scene::Spring{.damping = 5});
    scene.spheres[0].position = {-0.3, 0, 0.2};
    scene.quality.substepsFixed = false;
    const auto simulation = simulate(scene);
    ASSERT_TRUE(simulation->apply(sim::Set{.gravity = glm::dvec3(-9, 0, 0)}));
    run(*simulation, 3);
    EXPECT_LT(glm::distance(placeOf(*simulation), glm::dvec3(0, 0, 0.2)), 2e-3 * fieldRadius);
    const auto none = simulation->apply(sim::Set{.gravity = glm::dvec3(0)});
    ASSERT_FALSE(none);
    EXPECT_EQ(
        none.error().text(),
        "gravity: fields[0].buoyancy needs gravity, which is zero; give the scene a gravity or remove the buoyancy");
}

// Heavy spheres in water rest on the floor and sleep. A sphere that the water carries drifts on.
TEST(LiquidsAndSleep, OnlySpheresThatContactsCarrySleep) {
    for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced}) {
        scene::Scene scene = sleepyBox(1);
        scene.quality.model = model;
        scene.materials[0].friction = 0.3;
        scene.spheres = {{.position = {-0.3, 0, -0.45}, .radius = 0.05F},
                         {.position = {0.2, 0, 0.1}, .velocity = {0.01F, 0, 0}, .radius = 0.05F}};
        scene.spheres[1].material = measure::addMaterial(scene, {.name = "light", .density = 400});
        scene.forces.fields = {scene::Buoyancy{.density = 400}};
        const auto simulation = simulate(scene);
        run(*simulation, 4);
        const sim::State state = simulation->snapshot();
        EXPECT_TRUE(asleep(state, 0)) << scene::nameOf(model);
        EXPECT_FALSE(asleep(state, 1)) << scene::nameOf(model);
        EXPECT_NEAR(positionOf(state, 1).x, 0.24, 1e-3);
    }
}

INSTANTIATE_TEST_SUITE_P(Of, Liquids, testing::ValuesIn(fieldModels),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

}  // namespace
}  // namespace spherule::physics
