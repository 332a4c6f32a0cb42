// Friction, rolling and spinning resistance of touching pairs in the model `balanced`.
#include <gtest/gtest.h>

#include <algorithm>

#include <glm/geometric.hpp>

#include "kernels_bed.h"

namespace spherule::kernels {
namespace {

constexpr vec3 across(0.6F, 0.64F, 0.48F);  // unit length
constexpr float plenty = 10;                // N s

constexpr std::uint64_t rough = Feature::BALANCED | Feature::CONTACTS | Feature::FRICTION;

// Solves the contacts once. They hold this normal impulse (N s), and the velocities contain it.
void rub(Bed& bed, float pressing) {
    bed.pressAll(pressing);
    bed.solve();
}

// Two equal spheres of 0.5 m and 1 kg that touch, with this contact law.
Bed pairWith(vec4 law) {
    Bed bed({vec4(across, 0.5F), vec4(0, 0, 0, 0.5F)}, rough);
    bed.parameters.contact = law;
    bed.rebuild();
    return bed;
}

// A pair that slides and spins in all directions.
Bed slidingPair(float friction) {
    Bed bed = pairWith(vec4(0, friction, 0, 0));
    // They neither approach nor part.
    const vec3 speed(1, -2, 0.5F);
    bed.setVelocity(0, speed - across * glm::dot(speed, across));
    bed.setSpin(0, {3, 1, -2});
    bed.setSpin(1, {-1, 4, 2});
    return bed;
}

void expectNear(vec3 value, vec3 wanted, float within = 1e-5F) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(value[axis], wanted[axis], within) << "axis " << axis;
}

// Quantities that contacts do not change.
struct Conserved {
    explicit Conserved(const Bed& bed) : momentum(bed.momentum()), angularMomentum(bed.angularMomentum()) {}
    void expectIn(const Bed& bed) const {
        expectNear(bed.momentum(), momentum);
        expectNear(bed.angularMomentum(), angularMomentum);
    }
    vec3 momentum;
    vec3 angularMomentum;
};

TEST(KernelsAsCpp, FrictionStopsSlipUnderEnoughPressure) {
    Bed bed = slidingPair(0.5F);
    const Conserved conserved(bed);
    const float energy = bed.energy();
    ASSERT_GT(glm::length(bed.slip(0, 1)), 1);
    rub(bed, plenty);
    expectNear(bed.slip(0, 1), vec3(0));
    EXPECT_NEAR(bed.partingSpeed(0, 1), 0, 1e-6F);
    conserved.expectIn(bed);
    EXPECT_LT(bed.energy(), energy);
}

TEST(KernelsAsCpp, FrictionIsLimitedByCoulombsLaw) {
    const float friction = 0.5F;
    const float pressing = 0.02F;
    Bed bed = slidingPair(friction);
    const Conserved conserved(bed);
    const vec3 slip = bed.slip(0, 1);
    const vec3 speed = bed.velocityOf(0);
    rub(bed, pressing);
    const vec3 impulse = -friction * pressing * glm::normalize(slip);
    expectNear(bed.velocityOf(0) - speed, impulse);
    expectNear(bed.slip(0, 1), slip + 3.5F * 2 * impulse);
    conserved.expectIn(bed);
}

TEST(KernelsAsCpp, NoFrictionWithoutPressure) {
    Bed bed = slidingPair(0.5F);
    const auto before = bed.velocity;
    const auto spin = bed.angularVelocity;
    rub(bed, 0);
    for (uint slot = 0; slot < 2; ++slot) {
        expectNear(vec3(bed.velocity[slot]), vec3(before[slot]), 1e-6F);
        expectNear(vec3(bed.angularVelocity[slot]), vec3(spin[slot]), 1e-6F);
    }
}

// Friction that the contact holds is part of the velocities. The contact takes back all that exceeds Coulomb's law.
TEST(KernelsAsCpp, HeldFrictionFollowsThePressure) {
    const vec3 along = glm::normalize(glm::cross(across, vec3(1, 2, 3)));
    for (const float held : {0.005F, 0.02F}) {
        Bed bed = pairWith(vec4(0, 0.5F, 0, 0));
        const Conserved conserved(bed);
        const uint k = bed.listed().at(0);
        const vec3 normal = bed.normal(bed.idsOf(k).x, bed.idsOf(k).y);
        bed.remember(k, 0.02F * normal + held * along, glm::cross(normal, held * along));
        bed.solve();
        const float kept = std::min(held, 0.5F * 0.02F);
        expectNear(bed.remembered(k), 0.02F * normal + kept * along, 1e-6F);
        expectNear(bed.rememberedTorque(k), glm::cross(normal, kept * along), 1e-6F);
        expectNear(vec3(bed.velocity[bed.pairs[k].x]), (kept - held) * along, 1e-6F);
        conserved.expectIn(bed);
    }
}

// A pair with different radii, masses and materials.
Bed unequalPair(vec4 law, std::uint64_t features) {
    Bed bed({vec4(0.8F * across, 0.5F), vec4(0, 0, 0, 0.3F)}, rough | Feature::RADII | Feature::MATERIALS | features);
    bed.setMass(0, 2);
    bed.setMass(1, 0.3F);
    bed.idAndMaterial[0] |= 1U << 24U;
    bed.parameters.materials = 2;
    bed.contactParams.assign(4, layout::ContactParams{});
    bed.contactParams[1].contact = law;
    bed.contactParams[2].contact = law;
    bed.rebuild();
    const vec3 speed(1, -2, 0.5F);
    bed.setVelocity(1, speed - across * glm::dot(speed, across));
    bed.setSpin(0, {3, 1, -2});
    bed.setSpin(1, {-1, 4, 2});
    return bed;
}

TEST(KernelsAsCpp, FrictionUsesRadiiMassesAndMaterials) {
    Bed sticking = unequalPair(vec4(0, 0.5F, 0, 0), 0);
    const Conserved conserved(sticking);
    rub(sticking, plenty);
    expectNear(sticking.slip(0, 1), vec3(0), 2e-5F);
    conserved.expectIn(sticking);

    Bed sliding = unequalPair(vec4(0, 0.5F, 0, 0), 0);
    const vec3 slip = sliding.slip(0, 1);
    rub(sliding, 0.02F);
    expectNear(sliding.slip(0, 1), slip - 3.5F * (0.5F + 1 / 0.3F) * 0.01F * glm::normalize(slip));
    conserved.expectIn(sliding);
}

// Rolling resistance comes first, and friction turns the spheres again: both end within a few visits.
TEST(KernelsAsCpp, RollingResistanceAndFrictionStopRollAndSlip) {
    Bed bed = unequalPair(vec4(0, 0.5F, 0.5F, 0.5F), Feature::ROLLING);
    const Conserved conserved(bed);
    float energy = bed.energy();
    rub(bed, plenty);
    expectNear(bed.slip(0, 1), vec3(0), 2e-5F);
    for (int visit = 0; visit < 30; ++visit) {
        EXPECT_LT(bed.energy(), energy + 1e-6F);
        energy = bed.energy();
        rub(bed, plenty);
        expectNear(bed.slip(0, 1), vec3(0), 2e-5F);
    }
    expectNear(bed.spinOf(0), bed.spinOf(1), 1e-4F);
    conserved.expectIn(bed);
}

// Returns the moment of inertia of a solid sphere.
float inertiaOf(const Bed& bed, uint id) {
    return 0.4F * bed.massOf(id) * bed.radiusOf(id) * bed.radiusOf(id);
}

constexpr float lever = 0.5F * 0.3F / (0.5F + 0.3F);  // effective radius of the unequal pair (m)

TEST(KernelsAsCpp, RollingIsSlowedByItsResistance) {
    const float resistance = 0.1F;
    const float pressing = 0.2F;
    Bed bed = unequalPair(vec4(1, 0, resistance, 0), Feature::ROLLING);
    const vec3 axis = glm::normalize(glm::cross(across, vec3(1, 0, 0)));
    // The spheres turn like two gears, without slip.
    bed.setVelocity(1, vec3(0));
    bed.setSpin(0, 3.0F * axis);
    bed.setSpin(1, -5.0F * axis);
    const Conserved conserved(bed);
    rub(bed, pressing);
    const float moment = resistance * lever * pressing;
    expectNear(bed.spinOf(0), (3 - moment / inertiaOf(bed, 0)) * axis);
    expectNear(bed.spinOf(1), (-5 + moment / inertiaOf(bed, 1)) * axis);
    conserved.expectIn(bed);
}

TEST(KernelsAsCpp, SpinningAboutTheNormalIsSlowedByItsResistance) {
    const float resistance = 0.1F;
    const float pressing = 0.2F;
    for (const float direction : {1.0F, -1.0F}) {
        Bed bed = unequalPair(vec4(0, 10, 0, resistance), Feature::ROLLING);
        bed.setVelocity(1, vec3(0));
        bed.setSpin(0, direction * 5 * across);
        bed.setSpin(1, vec3(0));
        const Conserved conserved(bed);
        rub(bed, pressing);
        const float moment = direction * resistance * lever * pressing;
        expectNear(bed.spinOf(0), (direction * 5 - moment / inertiaOf(bed, 0)) * across);
        expectNear(bed.spinOf(1), moment / inertiaOf(bed, 1) * across);
        rub(bed, plenty);
        expectNear(bed.spinOf(0), bed.spinOf(1));
        conserved.expectIn(bed);
    }
}

// An impact with friction: the impulse along the surface is limited by the impulse along the normal.
TEST(KernelsAsCpp, FrictionOfAnExactImpactIsLimitedByCoulombsLaw) {
    const vec3 speed = -2.0F * across + glm::cross(across, vec3(1, 2, 3));
    for (const float friction : {0.1F, 10.0F})
        for (const float phase : {0.1F, 0.9F}) {
            Bed bed({vec4(across, 0.5F), vec4(0, 0, 0, 0.5F)}, rough | Feature::RESTITUTION);
            bed.setMass(1, 3);
            bed.parameters.contact = vec4(0.5F, friction, 0, 0);
            bed.rebuild();
            bed.setVelocity(0, speed);
            bed.setPlace(0, bed.at(0) - phase * bed.parameters.substep * speed);
            const Conserved conserved(bed);
            const float energy = bed.energy();
            bed.substep();
            for (const uint id : {0U, 1U})
                bed.setPlace(id, bed.at(id) - (1 - phase) * bed.parameters.substep * bed.velocityOf(id));
            conserved.expectIn(bed);
            // The normal impulse is (1 + e) v m*. A friction impulse J changes the slip by 7/2 J / m*.
            const vec3 slip = speed + 2.0F * across;
            const vec3 wanted = friction < 1 ? slip - 3.5F * friction * 1.5F * 2.0F * glm::normalize(slip) : vec3(0);
            expectNear(bed.slip(0, 1), wanted, 5e-5F);
            EXPECT_NEAR(bed.partingSpeed(0, 1), 1, 1e-5F);
            EXPECT_LT(bed.energy(), energy);
        }
}

}  // namespace
}  // namespace spherule::kernels
