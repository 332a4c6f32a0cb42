#include "reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

// Checks that the reference itself obeys the contact laws.
namespace spherule::reference {
namespace {

constexpr double h = 1.0 / 480;

World pair(double restitution, double inverseMassOfSecond) {
    World world;
    world.spheres = {{{-0.1, 0, 0}, {1, 0, 0}, 0.05, 1, restitution},
                     {{0.1, 0.03, 0}, {-1, 0, 0}, 0.06, inverseMassOfSecond, restitution}};
    return world;
}

TEST(Reference, FreeSphereFollowsAParabola) {
    World world;
    world.gravity = {0, 0, -9.81};
    world.spheres = {{{0, 0, 0}, {1, 0, 2}, 0.05, 1, 0.5}};
    for (int k = 0; k < 480; ++k) world.substep(h);
    EXPECT_NEAR(world.spheres[0].x.x, 1, 1e-12);
    EXPECT_NEAR(world.spheres[0].x.z, 2 - 9.81 / 2, 1e-12);
}

TEST(Reference, CollisionsConserveMomentumAndElasticOnesEnergy) {
    for (const double e : {0.0, 0.5, 1.0}) {
        World world = pair(e, 0.25);
        for (int k = 0; k < 100; ++k) world.substep(h);
        const Sphere& a = world.spheres[0];
        const Sphere& b = world.spheres[1];
        EXPECT_NEAR(a.v.x + 4 * b.v.x, 1 - 4, 1e-12);
        EXPECT_NEAR(a.v.y + 4 * b.v.y, 0, 1e-12);
        EXPECT_NE(a.v.x, 1) << "they never met";
        if (e == 1) {
            EXPECT_NEAR(glm::dot(a.v, a.v) + 4 * glm::dot(b.v, b.v), 5, 1e-12);
        }
    }
}

TEST(Reference, BounceHeightScalesWithRestitutionSquared) {
    World world;
    world.gravity = {0, 0, -9.81};
    world.walls = {{{0, 0, 0}, {0, 0, 1}, 0.8}};
    world.spheres = {{{0, 0, 1.05}, {0, 0, 0}, 0.05, 1, 0.8}};
    for (int k = 0; k < 400; ++k) world.substep(h);  // between the first bounce (0.45 s) and the second (1.17 s)
    const Sphere& ball = world.spheres[0];
    EXPECT_NEAR(ball.x.z - 0.05 + ball.v.z * ball.v.z / (2 * 9.81), 0.64, 0.64 * 1e-9);
}

TEST(Reference, SphereAtRestOnTheFloorDoesNotMove) {
    World world;
    world.gravity = {0, 0, -9.81};
    world.walls = {{{0, 0, 0}, {0, 0, 1}, 0, 0.5}};
    world.spheres = {{{0, 0, 0.05}, {0, 0, 0}, 0.05, 1, 0, 0.5}};
    for (int k = 0; k < 480; ++k) world.substep(h);
    EXPECT_NEAR(world.spheres[0].x.z, 0.05, 1e-12);
    EXPECT_NEAR(world.largestOverlap(), 0, 1e-12);
}

// Without friction and restitution, the floor is a spring of 0.2 periods per substep.
TEST(Reference, SphereWithoutFrictionRestsOnASpring) {
    World world;
    world.gravity = {0, 0, -9.81};
    world.walls = {{{0, 0, 0}, {0, 0, 1}, 0, 0}};
    world.spheres = {{{0, 0, 0.05}, {0, 0, 0}, 0.05, 1, 0, 0}};
    for (int k = 0; k < 480; ++k) world.substep(h);
    const double frequency = 2 * std::numbers::pi * 0.2 / h;
    EXPECT_NEAR(world.spheres[0].x.z, 0.05 - 9.81 / (frequency * frequency), 1e-12);
}

TEST(Reference, FrictionConservesMomentumAndAngularMomentum) {
    World world = pair(0.5, 0.25);
    for (Sphere& sphere : world.spheres) sphere.friction = 0.3;
    const auto angular = [&] {
        glm::dvec3 sum{};
        for (const Sphere& s : world.spheres)
            sum += (glm::cross(s.x, s.v) + 0.4 * s.radius * s.radius * s.spin) / s.inverseMass;
        return sum;
    };
    const glm::dvec3 before = angular();
    for (int k = 0; k < 100; ++k) world.substep(h);
    EXPECT_NEAR(world.spheres[0].v.x + 4 * world.spheres[1].v.x, 1 - 4, 1e-12);
    EXPECT_LT(glm::length(angular() - before), 1e-12);
    EXPECT_GT(glm::length(world.spheres[0].spin), 0.1) << "they never met";
}

// A sphere slides until it rolls, at 5/7 of its speed.
TEST(Reference, SlidingSphereRollsInTheEnd) {
    World world;
    world.gravity = {0, 0, -9.81};
    world.walls = {{{0, 0, 0}, {0, 0, 1}, 0, 0.3}};
    world.spheres = {{{0, 0, 0.05}, {1, 0, 0}, 0.05, 1, 0, 0.3}};
    for (int k = 0; k < 480; ++k) world.substep(h);
    EXPECT_NEAR(world.spheres[0].v.x, 5.0 / 7, 1e-9);
    EXPECT_NEAR(world.spheres[0].spin.y * 0.05, 5.0 / 7, 1e-9);
}

}  // namespace
}  // namespace spherule::reference
