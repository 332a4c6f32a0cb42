#include "reference.h"

#include <gtest/gtest.h>

#include <cmath>

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
    world.walls = {{{0, 0, 0}, {0, 0, 1}, 0}};
    world.spheres = {{{0, 0, 0.05}, {0, 0, 0}, 0.05, 1, 0}};
    for (int k = 0; k < 480; ++k) world.substep(h);
    EXPECT_NEAR(world.spheres[0].x.z, 0.05, 1e-12);
    EXPECT_NEAR(world.largestOverlap(), 9.81 * h * h / 2, 1e-12);
}

}  // namespace
}  // namespace spherule::reference
