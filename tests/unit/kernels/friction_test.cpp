// Friction, rolling and spinning resistance of touching pairs in the model `balanced`.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "kernels_bed.h"

namespace spherule::kernels {
namespace {

constexpr vec3 across(0.6F, 0.64F, 0.48F);  // unit length
constexpr float plenty = 1000;              // N s

void rub(Bed& bed, float pressing) {
    bed.pressAll(pressing);
    bed.sweep("solve_friction");
}

// Two equal spheres of 0.5 m and 1 kg that touch, with this contact law.
Bed pairWith(vec4 law) {
    Bed bed({vec4(across, 0.5F), vec4(0, 0, 0, 0.5F)}, Feature::FRICTION);
    bed.parameters.contact = law;
    bed.rebuild();
    return bed;
}

// A pair that slides and spins in all directions.
Bed slidingPair(float friction) {
    Bed bed = pairWith(vec4(0, friction, 0, 0));
    bed.setVelocity(0, {1, -2, 0.5F});
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
    const vec3 normalSpeed = bed.normal(0, 1) * glm::dot(bed.velocityOf(0) - bed.velocityOf(1), bed.normal(0, 1));
    ASSERT_GT(glm::length(bed.slip(0, 1)), 1);
    rub(bed, plenty);
    expectNear(bed.slip(0, 1), vec3(0));
    expectNear(bed.normal(0, 1) * glm::dot(bed.velocityOf(0) - bed.velocityOf(1), bed.normal(0, 1)), normalSpeed);
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
    for (const float pressing : {0.0F, -1.0F}) {
        Bed bed = slidingPair(0.5F);
        const auto before = bed.velocity;
        rub(bed, pressing);
        EXPECT_EQ(bed.velocity, before) << pressing << " N s";
    }
}

// A pair with different radii, masses and materials.
Bed unequalPair(vec4 law, std::uint64_t features) {
    Bed bed({vec4(0.8F * across, 0.5F), vec4(0, 0, 0, 0.3F)},
            Feature::FRICTION | Feature::RADII | Feature::MATERIALS | features);
    bed.setMass(0, 2);
    bed.setMass(1, 0.3F);
    bed.idAndMaterial[0] |= 1U << 24U;
    bed.parameters.materials = 2;
    bed.contactParams.assign(4, layout::ContactParams{});
    bed.contactParams[1].contact = law;
    bed.contactParams[2].contact = law;
    bed.rebuild();
    bed.setVelocity(1, {1, -2, 0.5F});
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

TEST(KernelsAsCpp, RollingResistanceAndFrictionStopRollAndSlipTogether) {
    Bed bed = unequalPair(vec4(0, 0.5F, 0.5F, 0.5F), Feature::ROLLING);
    const Conserved conserved(bed);
    const float energy = bed.energy();
    rub(bed, plenty);
    expectNear(bed.slip(0, 1), vec3(0), 2e-5F);
    expectNear(bed.spinOf(0), bed.spinOf(1), 2e-5F);
    conserved.expectIn(bed);
    EXPECT_LT(bed.energy(), energy);
}

// Returns the moment of inertia of a solid sphere.
float inertiaOf(const Bed& bed, uint id) {
    return 0.4F * bed.massOf(id) * bed.radiusOf(id) * bed.radiusOf(id);
}

constexpr float lever = 0.5F * 0.3F / (0.5F + 0.3F);  // effective radius of the unequal pair (m)

TEST(KernelsAsCpp, RollingIsSlowedByItsResistance) {
    const float resistance = 0.1F;
    const float pressing = 0.2F;
    Bed bed = unequalPair(vec4(0, 10, resistance, 0), Feature::ROLLING);
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

}  // namespace
}  // namespace spherule::kernels
