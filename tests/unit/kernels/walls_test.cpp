// Contacts of a sphere with walls and obstacles in the model `balanced`.
#include <gtest/gtest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "kernels_bed.h"

namespace spherule::kernels {
namespace {

constexpr std::uint64_t bouncing = Feature::BALANCED | Feature::RESTITUTION | Feature::WALLS;
constexpr float h = 1 / 480.0F;
constexpr uint floorSurface = 4;  // of the six faces: x- x+ y- y+ z- z+
constexpr uint floorRow = 2;      // of the rows of a sphere: one for each axis of the bounds, then obstacles

void expectNear(vec3 value, vec3 wanted, float within) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(value[axis], wanted[axis], within) << "axis " << axis;
}

// A sphere of 0.5 m and 2 kg, above a floor at z = 0.
Bed sphereAt(vec3 place, vec4 law, std::uint64_t features = bouncing) {
    Bed bed({vec4(place, 0.5F)}, features);
    bed.setMass(0, 2);
    bed.parameters.wallMin.z = 0;
    bed.parameters.closedFaces = 1U << floorSurface;
    bed.contactParams[0].contact = law;
    return bed;
}

void underGravity(Bed& bed, vec3 g = vec3(0, 0, -9.81F)) {
    bed.features |= Feature::GRAVITY;
    bed.parameters.gravity = vec4(g, 0);
    bed.parameters.gravityChange = glm::length(g) * h;
}

TEST(KernelsAsCpp, SphereBouncesWhereItMeetsTheFloor) {
    for (const float restitution : {0.0F, 0.4F, 1.0F})
        for (const float phase : {0.05F, 0.35F, 0.65F, 0.95F}) {
            Bed bed = sphereAt({0, 0, 0.5F + 3 * phase * h}, vec4(restitution, 0, 0, 0));
            bed.setVelocity(0, {1, 0, -3});
            bed.substep();
            expectNear(bed.velocityOf(0), {1, 0, 3 * restitution}, 2e-6F);
            expectNear(bed.at(0), {h, 0, 0.5F + 3 * restitution * (1 - phase) * h}, 1e-6F);
        }
}

// Each of the six faces, and a plane that slants.
TEST(KernelsAsCpp, SphereBouncesFromEachSurface) {
    constexpr vec3 slanting(0.6F, 0.64F, 0.48F);
    for (uint surface = 0; surface <= 6; ++surface) {
        vec3 normal(0);
        if (surface < 6)
            normal[static_cast<int>(surface / 2)] = surface % 2 == 0 ? 1.0F : -1.0F;
        else
            normal = slanting;
        Bed bed = sphereAt(0.501F * normal, vec4(0.8F, 0, 0, 0), bouncing | Feature::OBSTACLES | Feature::PLANES);
        bed.parameters.wallMin = vec4(-100, -100, -100, 0);
        bed.parameters.closedFaces = surface < 6 ? 1U << surface : 0;
        bed.setObstacles(surface < 6 ? 0 : 1);
        if (surface < 6) {
            vec4& face = surface % 2 == 0 ? bed.parameters.wallMin : bed.parameters.wallMax;
            face[static_cast<int>(surface / 2)] = 0;
        }
        bed.obstacles[0].a = vec4(slanting, 0);
        bed.setVelocity(0, -2.0F * normal);
        bed.substep();
        expectNear(bed.velocityOf(0), 1.6F * normal, 3e-6F);
    }
}

TEST(KernelsAsCpp, SphereBouncesFromFacesEdgesAndCornersOfABox) {
    for (const vec3 from : {vec3(0, 0, 1), vec3(0.6F, 0, 0.8F), vec3(-0.48F, 0.64F, 0.6F), vec3(0, -1, 0)}) {
        const vec3 corner(from.x > 0 ? 1 : (from.x < 0 ? -1 : 0), from.y > 0 ? 1 : (from.y < 0 ? -1 : 0),
                          from.z > 0 ? 1 : 0);
        Bed bed = sphereAt(corner + 0.501F * from, vec4(0.8F, 0, 0, 0), bouncing | Feature::OBSTACLES | Feature::BOXES);
        bed.parameters.closedFaces = 0;
        bed.setObstacles(1, 1);
        bed.obstacles[0].a = vec4(-1, -1, -1, 0);
        bed.obstacles[0].b = vec4(1, 1, 1, 0);
        bed.setVelocity(0, -2.0F * from);
        bed.substep();
        expectNear(bed.velocityOf(0), 1.6F * from, 1e-5F);
    }
}

TEST(KernelsAsCpp, ElasticSphereKeepsItsEnergyOverManyBounces) {
    Bed bed = sphereAt({0, 0, 0.6F}, vec4(1, 0, 0, 0));
    underGravity(bed);
    const auto energy = [&] {
        return 9.81F * (bed.at(0).z - 0.5F) + 0.5F * glm::dot(bed.velocityOf(0), bed.velocityOf(0));
    };
    const float start = energy();
    uint bounces = 0;
    bool fell = false;
    for (int substep = 0; substep < 1000; ++substep) {
        bed.substep();
        if (fell && bed.velocityOf(0).z > 0) ++bounces;
        fell = bed.velocityOf(0).z < 0;
        EXPECT_NEAR(energy(), start, 1e-4F * start);
    }
    EXPECT_GE(bounces, 6U);
}

TEST(KernelsAsCpp, WallAtRestHoldsTheWeight) {
    for (const float friction : {0.0F, 0.3F}) {
        Bed bed = sphereAt({0, 0, 0.5F}, vec4(0.5F, friction, 0, 0), bouncing | Feature::FRICTION);
        underGravity(bed);
        for (int substep = 0; substep < 200; ++substep) bed.substep();
        const vec3 still = bed.at(0);
        for (int substep = 0; substep < 200; ++substep) {
            bed.substep();
            EXPECT_LT(glm::length(bed.velocityOf(0)), 1.5e-5F) << "the position's last place in each substep";
        }
        expectNear(bed.at(0), still, 1e-6F);
        EXPECT_NEAR(still.z, 0.5F, 5.1e-4F);
        const vec4 held = bed.wallImpulse[floorRow];
        expectNear(vec3(held), {0, 0, 2 * 9.81F * h}, 1e-6F);
        EXPECT_EQ(held.w, static_cast<float>(floorSurface + 1));
    }
}

// Friction holds the sphere on a slope that is less steep than its angle, and the contact remembers the force.
TEST(KernelsAsCpp, FrictionHoldsASphereThatCannotRoll) {
    Bed bed = sphereAt({0, 0, 0.5F}, vec4(0, 0.5F, 1, 1), bouncing | Feature::FRICTION | Feature::ROLLING);
    const vec3 g(9.81F * std::sin(0.3F), 0, -9.81F * std::cos(0.3F));
    underGravity(bed, g);
    for (int substep = 0; substep < 500; ++substep) bed.substep();
    const vec3 still = bed.at(0);
    for (int substep = 0; substep < 480; ++substep) bed.substep();
    EXPECT_LT(glm::distance(bed.at(0), still), 1e-5F) << "in one second";
    expectNear(vec3(bed.wallImpulse[floorRow]), -2.0F * h * g, 1e-4F * 9.81F * h);
}

// A sphere that slides slows by friction times g until it rolls, at 5/7 of its speed.
TEST(KernelsAsCpp, SlidingSphereSlowsUntilItRolls) {
    const float friction = 0.3F;
    Bed bed = sphereAt({0, 0, 0.5F}, vec4(0, friction, 0, 0), bouncing | Feature::FRICTION);
    underGravity(bed);
    bed.setVelocity(0, {2, 1, 0});
    const float speed = glm::length(vec3(2, 1, 0));
    for (int substep = 0; substep < 48; ++substep) bed.substep();
    EXPECT_NEAR(glm::length(bed.velocityOf(0)), speed - friction * 9.81F * 0.1F, 1e-3F);
    for (int substep = 0; substep < 200; ++substep) bed.substep();
    expectNear(bed.velocityOf(0), vec3(2, 1, 0) * (5.0F / 7), 1e-3F);
    expectNear(bed.spinOf(0) * 0.5F, vec3(-1, 2, 0) * (5.0F / 7), 1e-3F);
}

TEST(KernelsAsCpp, WallsPushOutFullyWithoutSpeed) {
    Bed bed = sphereAt({0, 0, 0.45F}, vec4(1, 0, 0, 0));
    bed.substep();
    EXPECT_NEAR(bed.at(0).z, 0.5F - 0.0005F, 1e-6F);
    EXPECT_EQ(bed.velocityOf(0), vec3(0));
}

TEST(KernelsAsCpp, SphereThatLeavesTheWallForgetsIt) {
    Bed bed = sphereAt({0, 0, 0.5F}, vec4(0, 0.3F, 0, 0), bouncing | Feature::FRICTION);
    underGravity(bed);
    for (int substep = 0; substep < 10; ++substep) bed.substep();
    ASSERT_NE(bed.wallImpulse[floorRow].w, 0);
    bed.setVelocity(0, {0, 0, 1});
    bed.substep();
    EXPECT_EQ(bed.wallImpulse[floorRow].w, 0);
    EXPECT_EQ(bed.heldVelocity(0), vec3(0));
    EXPECT_NEAR(bed.velocityOf(0).z, 1 - 9.81F * h, 1e-6F);
}

// A groove of two planes: a sphere in it remembers both, if it has room for two.
TEST(KernelsAsCpp, MoreObstaclesThanRowsAreReported) {
    for (const uint rows : {5U, 4U}) {
        Bed bed = sphereAt({0, 0, std::sqrt(0.5F)}, vec4(0.5F, 0.3F, 0, 0),
                           bouncing | Feature::OBSTACLES | Feature::PLANES | Feature::FRICTION);
        bed.parameters.closedFaces = 0;
        bed.setObstacles(2);
        bed.parameters.maxWallHistory = rows;
        bed.wallImpulse.assign(rows, vec4(0));
        bed.wallTorque.assign(rows, vec4(0));
        const float half = std::sqrt(0.5F);
        bed.obstacles[0].a = vec4(half, 0, half, 0);
        bed.obstacles[1].a = vec4(-half, 0, half, 0);
        underGravity(bed);
        for (int substep = 0; substep < 100; ++substep) bed.substep();
        if (rows == 5) {
            EXPECT_EQ(bed.counters[COUNTER_DROPPED_WALLS], 0U);
            EXPECT_LT(glm::length(bed.velocityOf(0)), 1e-5F);
            expectNear(vec3(bed.wallImpulse[3] + bed.wallImpulse[4]), {0, 0, 2 * 9.81F * h}, 1e-5F);
        } else {
            EXPECT_GT(bed.counters[COUNTER_DROPPED_WALLS], 0U);
        }
    }
}

}  // namespace
}  // namespace spherule::kernels
