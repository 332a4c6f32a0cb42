// Fields that act in a region, in each model.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "field_support.h"
#include "scene/quality.h"

namespace spherule::physics {
namespace {

// The distance of a place from the region (m), negative inside; only its sign is exact.
double outsideBox(const scene::Box& box, const glm::dvec3& x) {
    const glm::dvec3 beyond = glm::abs(x - 0.5 * (box.min + box.max)) - 0.5 * (box.max - box.min);
    return std::max({beyond.x, beyond.y, beyond.z});
}

double outsideCylinder(const scene::CylinderRegion& cylinder, const glm::dvec3& x) {
    const glm::dvec3 way = cylinder.to - cylinder.from;
    const double along = glm::dot(x - cylinder.from, way) / glm::dot(way, way);
    const double beyondEnd = std::max(-along, along - 1) * glm::length(way);
    return std::max(beyondEnd, glm::distance(x, cylinder.from + along * way) - cylinder.radius);
}

// Places of 200 spheres at rest that do not touch: a region takes about a third of them.
scene::Scene atRest(scene::Model model, scene::Random& random) {
    scene::Scene scene = oneSphere(model, {}, {});
    scene.sphereContacts = false;
    scene.spheres.resize(200, scene.spheres[0]);
    for (scene::Sphere& sphere : scene.spheres)
        sphere.position = glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    return scene;
}

class FieldRegions : public testing::TestWithParam<scene::Model> {};

scene::Field limited(scene::Field field, const scene::Region& region) {
    std::visit([&](auto& one) { one.region = region; }, field);
    return field;
}

TEST_P(FieldRegions, OnlySpheresInsideFeelTheField) {
    scene::Random random(1);
    const glm::dvec3 gravity(0, 0, -5);
    const scene::Field fields[] = {scene::Drag{.density = 1e3, .velocity = {0, 2, 0}}, scene::Spring{{3, 0, 0}, 10},
                                   scene::Attraction{{0, 4, 0}, 10, 0.1}, scene::Buoyancy{.density = 3000}};
    for (const scene::Field& field : fields) {
        for (int shape = 0; shape < 3; ++shape) {
            scene::Scene scene = atRest(GetParam(), random);
            const scene::Box box{{-0.9, -0.4, -0.7}, {0.3, 0.8, 0.6}};
            const scene::BallRegion ball{0.3 * randomDirection(random), 0.8};
            const scene::CylinderRegion cylinder{-0.7 * randomDirection(random), 0.9 * randomDirection(random), 0.6};
            const scene::Region regions[] = {box, ball, cylinder};
            scene.forces = {.gravity = gravity, .fields = {limited(field, regions[shape])}};
            const scene::Forces everywhere{.gravity = gravity, .fields = {field}};
            const auto simulation = simulate(scene);
            run(*simulation, scene.step);
            int inside = 0;
            for (std::uint32_t id = 0; id < 200; ++id) {
                const glm::dvec3 x = scene.spheres[id].position;
                const double outside = shape == 0   ? outsideBox(box, x)
                                       : shape == 1 ? glm::distance(ball.centre, x) - ball.radius
                                                    : outsideCylinder(cylinder, x);
                if (std::abs(outside) < 1e-5) continue;
                const glm::dvec3 expected = outside < 0 ? accelerationOf(everywhere, x, {}) : gravity;
                EXPECT_LT(glm::distance(speedOf(*simulation, id) / scene.step, expected),
                          0.02 * glm::length(expected) + 1e-3)
                    << shape << " " << outside;
                inside += outside < 0 ? 1 : 0;
            }
            EXPECT_GT(inside, 10);
            EXPECT_LT(inside, 150);
        }
    }
}

// Across 1 m of still air, v falls by exp(-c 1 m), where c v^2 is the deceleration.
TEST_P(FieldRegions, ASlabOfAirSlowsASphereThatCrossesIt) {
    scene::Scene scene = oneSphere(GetParam(), {-1, 0.3, 0}, {4, 0, 0});
    const scene::Drag air{.density = 300, .region = scene::Box{{-0.5, -5, -5}, {0.5, 5, 5}}};
    scene.forces.fields = {air};
    const auto simulation = simulate(scene);
    const double c = glm::length(dragForce(air, {}, {1, 0, 0})) / fieldMass;  // 1/m
    run(*simulation, 0.1);
    EXPECT_EQ(speedOf(*simulation).x, 4) << "before";
    run(*simulation, 1.5);
    EXPECT_GT(placeOf(*simulation).x, 0.6);
    const double after = speedOf(*simulation).x;
    EXPECT_NEAR(after, 4 * std::exp(-c), 0.01);
    run(*simulation, 0.5);
    EXPECT_EQ(speedOf(*simulation).x, after) << "behind";
}

// Outside its region, a field has no potential.
TEST_P(FieldRegions, StatisticsCountTheSpheresInside) {
    scene::Random random(2);
    scene::Scene scene = atRest(GetParam(), random);
    const scene::BallRegion ball{{0.1, 0.2, 0}, 0.7};
    const scene::Spring spring{{0, 0, 1}, 20};
    scene.forces.fields = {limited(spring, ball)};
    double expected = 0;
    for (const scene::Sphere& sphere : scene.spheres) {
        const glm::dvec3 d = sphere.position - spring.centre;
        if (glm::distance(sphere.position, ball.centre) < ball.radius) expected += 0.5 * 20 * glm::dot(d, d);
    }
    EXPECT_NEAR(simulate(scene)->statistics().fieldEnergy, expected, 1e-5 * expected);
}

// Wind and regions add energy that statistics do not show; all else keeps it.
TEST(FieldEnergy, FieldsSayWhetherTheyAddEnergy) {
    const scene::Region region = scene::BallRegion{{}, 1};
    const auto adds = [](const scene::Field& field) { return scene::Forces{.fields = {field}}.addEnergy(); };
    EXPECT_FALSE(adds(scene::Drag{}));
    EXPECT_FALSE(adds(limited(scene::Drag{}, region)));
    EXPECT_TRUE(adds(scene::Drag{.velocity = {0, 0, 1}}));
    EXPECT_TRUE(adds(scene::Drag{.vortex = scene::Vortex{}}));
    for (const scene::Field& field :
         {scene::Field(scene::Spring{}), scene::Field(scene::Buoyancy{}), scene::Field(scene::Attraction{})}) {
        EXPECT_FALSE(adds(field));
        EXPECT_TRUE(adds(limited(field, region)));
    }
}

INSTANTIATE_TEST_SUITE_P(Of, FieldRegions, testing::ValuesIn(fieldModels),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

}  // namespace
}  // namespace spherule::physics
