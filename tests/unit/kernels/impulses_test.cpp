// Impacts of pairs in the model `fast`.
#include <gtest/gtest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "kernels_bed.h"

namespace spherule::kernels {
namespace {

constexpr vec3 across(0.6F, 0.64F, 0.48F);  // unit length
constexpr std::uint64_t bouncing = Feature::RESTITUTION;

void collide(Bed& bed) {
    bed.sweep("solve_impulses");
}

// The time since the two spheres touched (s).
float sinceTouch(const Bed& bed) {
    const vec3 d = bed.at(0) - bed.at(1);
    const vec3 c = bed.velocityOf(0) - bed.velocityOf(1);
    const float along = glm::dot(d, c);
    return (along + std::sqrt(along * along + glm::dot(c, c) * (1 - glm::dot(d, d)))) / glm::dot(c, c);
}

// Moves the two spheres back along their paths.
void goBack(Bed& bed, float seconds) {
    for (const uint id : {0U, 1U}) bed.setPlace(id, bed.at(id) - seconds * bed.velocityOf(id));
}

// Same as collide(), but begins and ends at the moment of impact.
void collideFromTouch(Bed& bed, float since) {
    goBack(bed, -since);
    collide(bed);
    goBack(bed, since);
    EXPECT_NEAR(glm::distance(bed.at(0), bed.at(1)), 1, 1e-6F);
}

// Two spheres of 1 and 3 kg that overlap by 0.01 m.
Bed pairWith(vec4 law, std::uint64_t features) {
    Bed bed({vec4(0.99F * across, 0.5F), vec4(0, 0, 0, 0.5F)}, features);
    bed.parameters.substep = 0.01F;
    bed.setMass(1, 3);
    bed.parameters.contact = law;
    bed.rebuild();
    return bed;
}

float partingSpeed(const Bed& bed) {
    return glm::dot(bed.velocityOf(0) - bed.velocityOf(1), bed.normal(0, 1));
}

vec3 along(const Bed& bed) {
    return bed.velocityOf(0) - bed.velocityOf(1) - bed.normal(0, 1) * partingSpeed(bed);
}

void expectNear(vec3 value, vec3 wanted, float within = 1e-5F) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(value[axis], wanted[axis], within) << "axis " << axis;
}

TEST(KernelsAsCpp, PairSeparatesWithItsRestitution) {
    for (const float restitution : {0.0F, 0.3F, 0.8F, 1.0F}) {
        Bed bed = pairWith(vec4(restitution, 0, 0, 0), bouncing);
        bed.setVelocity(0, {-3, -1, 0.5F});
        bed.setVelocity(1, {0, 0.5F, -1});
        const float since = sinceTouch(bed);
        goBack(bed, since);
        const float speed = partingSpeed(bed);
        ASSERT_LT(speed, -1);
        const vec3 momentum = bed.momentum();
        const vec3 sliding = along(bed);
        const float energy = bed.energy();
        collideFromTouch(bed, since);
        EXPECT_NEAR(partingSpeed(bed), -restitution * speed, 2e-6F);
        expectNear(bed.momentum(), momentum);
        expectNear(along(bed), sliding);
        EXPECT_NEAR(bed.energy(), energy - 0.5F * 0.75F * (1 - restitution * restitution) * speed * speed, 1e-5F);
    }
}

TEST(KernelsAsCpp, ImpactOfAnUnlistedPairIsTheSame) {
    Bed bed = pairWith(vec4(0.8F, 0, 0, 0), bouncing);
    bed.parameters.pairCapacity = 0;
    bed.rebuild();
    ASSERT_EQ(bed.counters[COUNTER_UNLISTED], bed.parameters.bundles);
    bed.setVelocity(0, -2.0F * across);
    collide(bed);
    EXPECT_NEAR(partingSpeed(bed), 1.6F, 2e-6F);
}

TEST(KernelsAsCpp, OverlapsAreRemovedWithoutChangingVelocities) {
    Bed bed = pairWith(vec4(1, 0, 0, 0), bouncing);
    bed.setVelocity(0, 2.0F * across);
    const auto velocity = bed.velocity;
    const vec3 centre = 1.0F / 4 * bed.at(0) + 3.0F / 4 * bed.at(1);
    collide(bed);
    EXPECT_EQ(bed.velocity, velocity) << "they part already";
    EXPECT_NEAR(glm::distance(bed.at(0), bed.at(1)), 1, 1e-6F);
    expectNear(1.0F / 4 * bed.at(0) + 3.0F / 4 * bed.at(1), centre, 1e-6F);
}

TEST(KernelsAsCpp, ImpactsWithinTheDeadBandDoNotBounce) {
    Bed bed = pairWith(vec4(1, 0, 0, 0), bouncing);
    bed.parameters.deadBand = 0.1F;
    bed.setVelocity(0, -0.09F * across);
    collide(bed);
    EXPECT_NEAR(partingSpeed(bed), 0, 1e-7F);
    bed.setPlace(0, 0.99F * across);
    bed.setPlace(1, vec3(0));
    bed.setVelocity(0, -0.11F * across);
    bed.setVelocity(1, vec3(0));
    collide(bed);
    EXPECT_NEAR(partingSpeed(bed), 0.11F, 1e-7F);
}

TEST(KernelsAsCpp, FrictionOfAnImpactIsLimitedByCoulombsLaw) {
    const vec3 speed = -2.0F * across + glm::cross(across, vec3(1, 2, 3));
    for (const float friction : {0.1F, 10.0F}) {
        Bed bed = pairWith(vec4(0.5F, friction, 0, 0), bouncing | Feature::FRICTION);
        bed.setVelocity(0, speed);
        const float since = sinceTouch(bed);
        goBack(bed, since);
        const vec3 momentum = bed.momentum();
        const vec3 angularMomentum = bed.angularMomentum();
        const float energy = bed.energy();
        const vec3 slip = bed.slip(0, 1);
        const float approach = -partingSpeed(bed);
        collideFromTouch(bed, since);
        // The normal impulse is (1 + e) v m*. A friction impulse J changes the slip by 7/2 J / m*.
        const vec3 wanted = friction < 1 ? slip - 3.5F * friction * 1.5F * approach * glm::normalize(slip) : vec3(0);
        expectNear(bed.slip(0, 1), wanted, 2e-5F);
        EXPECT_NEAR(partingSpeed(bed), 0.5F * approach, 1e-5F);
        expectNear(bed.momentum(), momentum);
        expectNear(bed.angularMomentum(), angularMomentum, 2e-5F);
        EXPECT_LT(bed.energy(), energy);
    }
}

}  // namespace
}  // namespace spherule::kernels
