// Contacts of spheres in the model `balanced`, without friction.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>
#include <set>

#include <glm/geometric.hpp>

#include "compute/cpu/host.h"
#include "kernels_bed.h"

namespace spherule::kernels {
namespace {

constexpr vec3 across(0.6F, 0.64F, 0.48F);  // unit length
constexpr std::uint64_t bouncing = Feature::BALANCED | Feature::CONTACTS | Feature::RESTITUTION;

void expectNear(vec3 value, vec3 wanted, float within) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(value[axis], wanted[axis], within) << "axis " << axis;
}

// Two spheres of 0.5 m with 1 and 3 kg, whose centres are `distance` apart (m).
Bed pairWith(vec4 law, float distance, std::uint64_t features = bouncing) {
    Bed bed({vec4(distance * across, 0.5F), vec4(0, 0, 0, 0.5F)}, features);
    bed.parameters.contact = law;
    bed.setMass(1, 3);
    bed.rebuild();
    return bed;
}

// Moves the two spheres along their paths.
void fly(Bed& bed, float seconds) {
    for (const uint id : {0U, 1U}) bed.setPlace(id, bed.at(id) + seconds * bed.velocityOf(id));
}

TEST(KernelsAsCpp, ImpactPartsFromThePointOfImpact) {
    const float h = 1 / 480.0F;
    for (const float restitution : {0.0F, 0.3F, 0.8F, 1.0F})
        for (const float phase : {0.05F, 0.35F, 0.65F, 0.95F}) {
            Bed bed = pairWith(vec4(restitution, 0, 0, 0), 1);
            bed.setVelocity(0, {-3, -1, 0.5F});
            bed.setVelocity(1, {0, 0.5F, -1});
            const vec3 met[] = {bed.at(0), bed.at(1)};
            const float speed = bed.partingSpeed(0, 1);
            ASSERT_LT(speed, -1);
            const vec3 sliding = bed.velocityOf(0) - bed.velocityOf(1) - speed * across;
            const vec3 momentum = bed.momentum();
            const float energy = bed.energy();
            fly(bed, -phase * h);
            bed.substep();
            fly(bed, -(1 - phase) * h);
            for (const uint id : {0U, 1U}) expectNear(bed.at(id), met[id], 2e-6F);
            EXPECT_NEAR(bed.partingSpeed(0, 1), -restitution * speed, 1e-5F);
            expectNear(bed.velocityOf(0) - bed.velocityOf(1) - bed.partingSpeed(0, 1) * across, sliding, 1e-5F);
            expectNear(bed.momentum(), momentum, 1e-5F);
            EXPECT_NEAR(bed.energy(), energy - 0.5F * 0.75F * (1 - restitution * restitution) * speed * speed, 3e-5F);
        }
}

TEST(KernelsAsCpp, SpheresThatMissEachOtherFlyOn) {
    Bed bed = pairWith(vec4(0.5F, 0, 0, 0), 1.001F);
    const vec3 sideways = glm::normalize(glm::cross(across, vec3(1, 2, 3)));
    bed.setVelocity(0, 30.0F * sideways);
    const auto velocity = bed.velocity;
    const vec3 to = bed.at(0) + 30.0F * bed.parameters.substep * sideways;
    bed.substep();
    EXPECT_EQ(bed.velocity, velocity);
    expectNear(bed.at(0), to, 1e-6F);
    EXPECT_EQ(bed.remembered(bed.listed().at(0)), vec3(0));
}

// A slower approach comes from the weight of a pile. It is stopped.
TEST(KernelsAsCpp, ApproachesBelowTwiceTheAccelerationDoNotBounce) {
    for (const auto& [speed, wanted] : {std::pair(0.038F, 0.0F), {0.042F, 0.042F}}) {
        Bed bed = pairWith(vec4(1, 0, 0, 0), 0.99995F);
        bed.parameters.gravityChange = 0.02F;  // m/s per substep; a and g are the same here
        bed.setVelocity(0, -speed * across);
        bed.substep();
        EXPECT_NEAR(bed.partingSpeed(0, 1), wanted, 2e-6F) << speed;
    }
}

// The mean of a sphere's changes of velocity follows them over eight substeps. It counts if it exceeds gravity.
TEST(KernelsAsCpp, OwnAccelerationIsAMeanOverSubsteps) {
    Bed bed({vec4(0, 0, 0, 0.5F)}, Feature::BALANCED | Feature::CONTACTS | Feature::GRAVITY);
    const float fall = 9.81F / 480;
    bed.parameters.gravity = vec4(0, 0, -9.81F, 0);
    bed.parameters.gravityChange = fall;
    // Begins substeps in which gravity and a held impulse change the velocity by `change` falls each.
    const auto meanAfter = [&](int substeps, float change) {
        for (int substep = 0; substep < substeps; ++substep) {
            bed.velocity[0] = vec4(0, 0, 0, 1);
            bed.unheldVelocity[0] = vec4(0, 0, (change - 1) * fall, 1);
            bed.begin();
        }
        return std::sqrt(bed.velocityBefore[0].w) / fall;
    };
    EXPECT_NEAR(meanAfter(40, 0), 1, 1e-4F);
    EXPECT_NEAR(meanAfter(8, 3), 3 * (1 - std::pow(0.875F, 8)), 1e-3F);
    // The mean ends where an eighth of its error is lost with the lowest bits of a component (shared/layout.h).
    const float lost = 8.0F / 4096;
    EXPECT_NEAR(meanAfter(60, 3), 3, 3 * lost);
    EXPECT_NEAR(meanAfter(4, 0), 3 * std::pow(0.875F, 4), 3 * lost);
    EXPECT_EQ(meanAfter(60, 1), 1) << "in free fall";
    for (int substep = 0; substep < 40; ++substep) {
        meanAfter(1, 3);
        meanAfter(1, 0);
    }
    EXPECT_NEAR(meanAfter(1, 3), 1.6F, 0.02F) << "every other substep";
}

// Nor does an approach below five times the change of velocity that the held impulse makes.
TEST(KernelsAsCpp, ApproachesOfALoadedContactDoNotBounce) {
    for (const auto& [speed, wanted] : {std::pair(0.19F, 0.0F), {0.21F, 0.21F}}) {
        Bed bed = pairWith(vec4(1, 0, 0, 0), 0.99995F);
        bed.setVelocity(0, -speed * across);
        bed.holdAll(0.04F * 0.75F);  // 0.75 kg is the effective mass
        bed.begin();
        EXPECT_NEAR(bed.partingSpeed(0, 1), 0.04F - speed, 1e-6F) << "the held impulse acts";
        bed.solve();
        EXPECT_NEAR(bed.partingSpeed(0, 1), wanted, 2e-6F) << speed;
    }
}

TEST(KernelsAsCpp, SlowApproachIsStoppedWhereTheSpheresTouch) {
    for (const float gap : {0.0F, 2e-5F, 4e-5F}) {
        Bed bed = pairWith(vec4(1, 0, 0, 0), 1 + gap);
        bed.parameters.gravityChange = 0.02F;
        bed.setVelocity(0, -0.03F * across);
        bed.substep();
        EXPECT_NEAR(glm::distance(bed.at(0), bed.at(1)), 1, 5e-7F);
    }
}

TEST(KernelsAsCpp, SpheresApartAreLeftAlone) {
    Bed bed = pairWith(vec4(1, 0, 0, 0), 1.05F);
    bed.setVelocity(0, -2.0F * across);
    ASSERT_EQ(bed.listed().size(), 1U);
    const auto velocity = bed.velocity;
    bed.substep();
    EXPECT_EQ(bed.velocity, velocity);
    EXPECT_EQ(bed.remembered(bed.listed()[0]), vec3(0));
}

TEST(KernelsAsCpp, OverlapsShrinkByMovingSpheresAlone) {
    Bed bed = pairWith(vec4(1, 0, 0, 0), 0.95F);
    bed.setVelocity(0, 2.0F * across);
    const auto velocity = bed.velocity;
    const vec3 centre = 1.0F / 4 * bed.at(0) + 3.0F / 4 * bed.at(1);
    bed.begin();
    bed.solve();
    EXPECT_EQ(bed.velocity, velocity) << "they part already";
    // 30 % of the overlap beyond the slop, which is 0.1 % of the radius.
    EXPECT_NEAR(glm::distance(bed.at(0), bed.at(1)), 0.95F + 0.3F * (0.05F - 0.0005F), 1e-6F);
    expectNear(1.0F / 4 * bed.at(0) + 3.0F / 4 * bed.at(1), centre, 1e-6F);
}

TEST(KernelsAsCpp, OverlapWithinTheSlopStays) {
    Bed bed = pairWith(vec4(1, 0, 0, 0), 0.9996F);
    const auto position = bed.position;
    bed.substep();
    EXPECT_EQ(bed.position, position);
}

// Without friction and restitution a spring parts the spheres: it moves nothing at once, and never swings.
TEST(KernelsAsCpp, SoftContactsPartWithoutSwinging) {
    Bed bed = pairWith(vec4(0.5F, 0, 0, 0), 0.98F);
    const auto position = bed.position;
    bed.begin();
    bed.solve();
    EXPECT_EQ(bed.position, position);
    const float speed = bed.partingSpeed(0, 1);
    EXPECT_GT(speed, 0.1F * 0.02F * 480);
    EXPECT_LT(speed, 0.5F * 0.02F * 480);
    bed.finish();
    for (int substep = 0; substep < 100; ++substep) {
        bed.substep();
        EXPECT_GE(bed.partingSpeed(0, 1), 0);
        EXPECT_LE(bed.partingSpeed(0, 1), speed * 1.0001F);
    }
    EXPECT_GE(glm::distance(bed.at(0), bed.at(1)), 1 - 1e-5F);
    expectNear(bed.momentum(), vec3(0), 1e-6F);
}

// A sphere on a sleeper, which nothing moves.
TEST(KernelsAsCpp, ContactAtRestHoldsTheWeight) {
    for (const float friction : {0.0F, 0.3F}) {
        Bed bed = pairWith(vec4(0.3F, friction, 0, 0), 0.9999F,
                           bouncing | Feature::GRAVITY | Feature::SLEEP | Feature::FRICTION);
        const float fall = 9.81F / 480;
        bed.parameters.gravity = vec4(-9.81F * across, 0);
        bed.parameters.gravityChange = fall;
        bed.parameters.wakeSpeed = 3 * fall;  // what comes faster would wait for the sleeper to wake
        bed.velocity[bed.slotOf(1)].w = -1.0F / 3;
        for (int substep = 0; substep < 200; ++substep) bed.substep();
        const vec3 still = bed.at(0);
        float fastest = 0;  // along the normal; without friction, it rolls off slowly
        for (int substep = 0; substep < 200; ++substep) {
            bed.substep();
            fastest = std::max(fastest, std::abs(bed.partingSpeed(0, 1)));
        }
        EXPECT_LT(fastest, 1.5e-5F) << "half a unit of the position's last place in each substep";
        EXPECT_NEAR(glm::length(bed.at(0)), glm::length(still), 1e-6F);
        EXPECT_EQ(bed.at(1), vec3(0));
        const uint k = bed.listed().at(0);
        const float direction = bed.idsOf(k).x == 0 ? 1 : -1;
        expectNear(bed.remembered(k), direction * fall * across, 1e-5F * fall + 1e-7F);
        expectNear(bed.heldVelocity(bed.slotOf(0)), fall * across, 1e-5F);
    }
}

TEST(KernelsAsCpp, ContactThatPartsHoldsNothing) {
    Bed bed = pairWith(vec4(0, 0.5F, 0, 0), 1, bouncing | Feature::FRICTION);
    bed.setVelocity(0, 2.0F * across);
    const auto velocity = bed.velocity;
    bed.holdAll(0.02F);
    bed.substep();
    EXPECT_EQ(bed.remembered(bed.listed().at(0)), vec3(0));
    for (uint id = 0; id < 2; ++id) {
        expectNear(bed.velocityOf(id), vec3(velocity[bed.slotOf(id)]), 1e-6F);
        EXPECT_EQ(bed.heldVelocity(bed.slotOf(id)), vec3(0));
    }
}

TEST(KernelsAsCpp, UnlistedPairHasTheSameImpactAndHoldsNothing) {
    Bed listed = pairWith(vec4(0.8F, 0, 0, 0), 1.002F);
    Bed unlisted = pairWith(vec4(0.8F, 0, 0, 0), 1.002F);
    unlisted.parameters.pairCapacity = 0;
    unlisted.rebuild();
    ASSERT_EQ(unlisted.counters[COUNTER_UNLISTED], unlisted.parameters.bundles);
    for (Bed* bed : {&listed, &unlisted}) {
        bed->setVelocity(0, -2.0F * across);
        bed->substep();
    }
    EXPECT_NEAR(listed.partingSpeed(0, 1), 1.6F, 3e-6F);
    EXPECT_EQ(listed.position, unlisted.position);
    EXPECT_EQ(listed.velocity, unlisted.velocity);
    for (uint slot = 0; slot < unlisted.count; ++slot) EXPECT_EQ(unlisted.heldVelocity(slot), vec3(0));
}

// 64 spheres with friction and rolling resistance, which fall on a floor and on each other.
Bed heap() {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> jitter(-0.06F, 0.06F);
    std::uniform_real_distribution<float> speed(-1, 1);
    std::vector<vec4> places;
    for (uint k = 0; k < 64; ++k) {
        const vec3 corner(static_cast<float>(k % 4), static_cast<float>(k / 4 % 4), static_cast<float>(k / 16));
        const vec3 place = (corner - 1.7F) * 0.98F + vec3(jitter(random), jitter(random), jitter(random));
        places.emplace_back(place, 0.42F + 0.02F * static_cast<float>(random() % 5));
    }
    Bed bed(places,
            bouncing | Feature::GRAVITY | Feature::FRICTION | Feature::ROLLING | Feature::RADII | Feature::WALLS);
    bed.parameters.gravity = vec4(0, 0, -9.81F, 0);
    bed.parameters.gravityChange = 9.81F / 480;
    bed.parameters.contact = vec4(0.5F, 0.4F, 0.05F, 0.05F);
    bed.contactParams[0].contact = bed.parameters.contact;
    bed.parameters.wallMin = vec4(-3, -3, -2.3F, 0);
    bed.parameters.wallMax = vec4(3, 3, 10, 0);
    bed.parameters.closedFaces = 0x3f;
    for (uint id = 0; id < bed.count; ++id) {
        bed.setMass(id, 1 + 0.1F * static_cast<float>(id % 7));
        bed.setVelocity(id, {speed(random), speed(random), speed(random)});
        bed.setSpin(id, {speed(random), speed(random), speed(random)});
    }
    bed.counters[COUNTER_REBUILD] = REBUILD_DUE;
    return bed;
}

// The same in a groove of two planes.
Bed heapInGroove() {
    Bed bed = heap();
    bed.features |= Feature::OBSTACLES | Feature::PLANES;
    bed.setObstacles(2);
    bed.parameters.maxWallHistory = 5;
    bed.wallImpulse.assign(5 * std::size_t{bed.count}, vec4(0));
    bed.wallTorque = bed.wallImpulse;
    bed.obstacles[0].a = vec4(0.6F, 0, 0.8F, -2.1F);
    bed.obstacles[1].a = vec4(-0.6F, 0, 0.8F, -2.1F);
    return bed;
}

// `row` of `unheldVelocity`: the sphere holds an impulse at this surface.
bool holdsAt(const vec4& row, uint surface) {
    return (static_cast<uint>(row.w * 128) >> std::min(surface, 6U) & 1U) != 0;
}

// The held changes of spheres follow the contacts through impacts, friction and rebuilds.
void expectSumsOfContacts(Bed bed, std::initializer_list<uint> surfaces) {
    float most = 0;
    std::set<uint> seen;
    for (int substep = 0; substep < 400; ++substep) {
        bed.substep();
        const Bed before = bed;
        bed.addUpHeld();
        for (uint slot = 0; slot < bed.count; ++slot) {
            const vec4& row = before.unheldVelocity[slot];
            expectNear(before.heldVelocity(slot), bed.heldVelocity(slot), 2e-5F);
            expectNear(before.heldSpin(slot), bed.heldSpin(slot), 1e-4F);
            EXPECT_EQ(row.w, bed.unheldVelocity[slot].w) << "pairs and surfaces";
            for (const uint surface : surfaces)
                if (holdsAt(row, surface)) seen.insert(surface);
            most = std::max(most, glm::length(before.heldVelocity(slot)));
        }
        if (testing::Test::HasFailure()) FAIL() << "substep " << substep;
        bed.unheldVelocity = before.unheldVelocity;
        bed.unheldSpin = before.unheldSpin;
    }
    EXPECT_GT(most, 2 * 9.81F / 480) << "contacts bear weight";
    EXPECT_GT(bed.counters[COUNTER_REBUILDS], 3U);
    EXPECT_EQ(seen, std::set<uint>(surfaces)) << "surfaces at which spheres held impulses";
}

TEST(KernelsAsCpp, SpheresHoldTheSumOfTheirContacts) {
    expectSumsOfContacts(heap(), {4});
    expectSumsOfContacts(heapInGroove(), {4, 6});
}

// A column of five at the middle of the cell grid stands on an edge. Its contacts hold impulses without x and y, which
// are exactly zero through substeps, rebuilds and another length of the substep.
TEST(KernelsAsCpp, ColumnHoldsNothingSideways) {
    for (const std::uint64_t friction : {std::uint64_t{0}, std::uint64_t{Feature::FRICTION}}) {
        std::vector<vec4> places;
        for (int k = 0; k < 5; ++k) places.emplace_back(0, 0, static_cast<float>(k), 0.5F);
        Bed bed(places, Feature::BALANCED | Feature::CONTACTS | Feature::GRAVITY | Feature::WALLS | friction);
        bed.parameters.contact = vec4(0, 0.5F, 0, 0);
        bed.parameters.gravity = vec4(0, 0, -9.81F, 0);
        bed.parameters.gravityChange = 9.81F / 480;
        bed.parameters.wallMin.z = -0.5F;
        bed.parameters.closedFaces = 1U << 4;
        bed.rebuild();
        for (int substep = 0; substep < 600; ++substep) {
            if (substep % 50 == 49) {
                bed.parameters.substepRatio = substep % 100 == 49 ? 0.5F : 2;
                bed.run("scale_pairs");
                bed.run("scale_spheres");
            }
            if (substep % 70 == 69) bed.rebuild();
            bed.substep();
        }
        for (const uint k : bed.listed()) {
            EXPECT_EQ(bed.remembered(k).x, 0);
            EXPECT_GT(std::abs(bed.remembered(k).z), 1e-3F) << "it bears weight";
        }
        for (uint id = 0; id < 5; ++id) {
            EXPECT_EQ(bed.at(id).x, 0);
            EXPECT_EQ(bed.velocityOf(id).x, 0);
            EXPECT_EQ(bed.spinOf(id), vec3(0));
            EXPECT_EQ(bed.heldVelocity(bed.slotOf(id)).x, 0);
        }
    }
}

TEST(KernelsAsCpp, ContactsConserveMomentum) {
    Bed bed = heap();
    bed.rebuild();
    for (int substep = 0; substep < 100; ++substep) {
        bed.begin();
        const vec3 momentum = bed.momentum();
        bed.solve();
        expectNear(bed.momentum(), momentum, 1e-4F);
        bed.finish();
        if ((bed.counters[COUNTER_REBUILD] & REBUILD_DUE) != 0) bed.rebuild();
    }
}

TEST(KernelsAsCpp, BitsDoNotDependOnTheNumberOfLanes) {
    Bed one = heap();
    for (int substep = 0; substep < 200; ++substep) one.substep();
    ASSERT_GT(one.counters[COUNTER_REBUILDS], 2U);
    for (unsigned lanes = 4; lanes <= compute::cpu::mostLanes(); lanes *= 2) {
        Bed many = heap();
        many.lanes = lanes;
        for (int substep = 0; substep < 200; ++substep) many.substep();
        EXPECT_EQ(many.position, one.position) << lanes;
        EXPECT_EQ(many.velocity, one.velocity) << lanes;
        EXPECT_EQ(many.angularVelocity, one.angularVelocity) << lanes;
        EXPECT_EQ(many.unheldVelocity, one.unheldVelocity) << lanes;
        EXPECT_EQ(many.unheldSpin, one.unheldSpin) << lanes;
        EXPECT_EQ(many.accelerationXz, one.accelerationXz) << lanes;
        EXPECT_EQ(many.accelerationYz, one.accelerationYz) << lanes;
        ASSERT_EQ(many.listed(), one.listed()) << lanes;
        for (const uint k : one.listed()) {
            EXPECT_EQ(many.remembered(k), one.remembered(k)) << lanes;
            EXPECT_EQ(many.rememberedTorque(k), one.rememberedTorque(k)) << lanes;
        }
        EXPECT_EQ(many.wallImpulse, one.wallImpulse) << lanes;
    }
}

}  // namespace
}  // namespace spherule::kernels
