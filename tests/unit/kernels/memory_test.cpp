// The memory of listed contacts: the slip in the model `accurate`, the impulse and its torque in `balanced`.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <utility>

#include <glm/geometric.hpp>

#include "kernels_bed.h"

namespace spherule::kernels {
namespace {

using Ids = std::pair<uint, uint>;  // the lower id first

struct Memory {
    vec3 value;   // the slip or the impulse of the sphere with the lower id
    vec3 torque;  // does not change sign if the pair is reversed
    bool operator==(const Memory&) const = default;
};

Memory seenByTheLower(const Bed& bed, uint pair) {
    const uvec2 ids = bed.idsOf(pair);
    return {ids.x < ids.y ? bed.remembered(pair) : -bed.remembered(pair), bed.rememberedTorque(pair)};
}

std::map<Ids, Memory> remembered(const Bed& bed) {
    std::map<Ids, Memory> found;
    for (const uint k : bed.listed()) found[std::minmax(bed.idsOf(k).x, bed.idsOf(k).y)] = seenByTheLower(bed, k);
    return found;
}

uint pairsWhoseFirstIsTheLower(const Bed& bed) {
    uint sum = 0;
    for (const uint k : bed.listed())
        if (bed.idsOf(k).x < bed.idsOf(k).y) ++sum;
    return sum;
}

// 64 spheres on a jittered lattice, in random order. Their radii are 0.42 to 0.5 m, some of them equal.
std::vector<vec4> cluster() {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> jitter(-0.08F, 0.08F);
    std::vector<vec4> places;
    for (uint k = 0; k < 64; ++k) {
        const vec3 corner(static_cast<float>(k % 4), static_cast<float>(k / 4 % 4), static_cast<float>(k / 16));
        const vec3 place = (corner - 1.7F) * 0.95F + vec3(jitter(random), jitter(random), jitter(random));
        places.emplace_back(place, 0.42F + 0.02F * static_cast<float>(random() % 5));
    }
    std::shuffle(places.begin(), places.end(), random);
    return places;
}

// Two thirds of the pairs remember something.
void rememberAtRandom(Bed& bed, bool torques) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> value(-1e-3F, 1e-3F);
    const auto any = [&] { return vec3(value(random), value(random), value(random)); };
    for (const uint k : bed.listed())
        if (random() % 3 == 0)
            bed.remember(k, vec3(0));
        else
            bed.remember(k, any(), torques ? any() : vec3(0));
}

// Mirrors all positions at the origin. Distances stay exactly the same, but almost all spheres change their slots.
void mirror(Bed& bed) {
    for (uint id = 0; id < bed.count; ++id) bed.setPlace(id, -bed.at(id));
}

TEST(KernelsAsCpp, ContactsKeepTheirMemoryAfterARebuild) {
    for (const std::uint64_t model : {Feature::ACCURATE | Feature::LOW_BITS, Feature::BALANCED | Feature::CONTACTS})
        for (const std::uint64_t features : {std::uint64_t{0}, std::uint64_t{Feature::RADII}}) {
            const bool balanced = (model & Feature::BALANCED) != 0;
            Bed bed(cluster(), Feature::FRICTION | model | features);
            for (uint id = 0; id < bed.count; ++id) bed.setSpin(id, vec3(static_cast<float>(id)));
            bed.rebuild();
            rememberAtRandom(bed, balanced);
            const auto before = remembered(bed);
            const uint lowerFirst = pairsWhoseFirstIsTheLower(bed);
            ASSERT_GT(before.size(), 100U);
            mirror(bed);
            bed.rebuild();
            EXPECT_EQ(remembered(bed), before);
            EXPECT_GT(bed.counters[COUNTER_CARRIED], 60U);
            EXPECT_EQ(bed.counters[COUNTER_RESTORED], bed.counters[COUNTER_CARRIED]);
            EXPECT_NE(pairsWhoseFirstIsTheLower(bed), lowerFirst)
                << "no pair has changed its order: the test is vacuous";
            for (uint id = 0; id < bed.count; ++id) EXPECT_EQ(bed.spinOf(id), vec3(static_cast<float>(id)));
        }
}

TEST(KernelsAsCpp, ImpulseChangesSignWhenAPairIsReversed) {
    Bed bed({vec4(0.6F, 0.5F, 0.5F, 0.5F), vec4(1.5F, 0.5F, 0.5F, 0.5F)},
            Feature::FRICTION | Feature::BALANCED | Feature::CONTACTS);
    bed.rebuild();
    ASSERT_EQ(bed.listed().size(), 1U);
    const uint k = bed.listed()[0];
    ASSERT_EQ(bed.idsOf(k), uvec2(0, 1));
    bed.remember(k, {1, 2, 3}, {4, 5, 6});
    bed.setPlace(0, {1.5F, 0.5F, 0.5F});
    bed.setPlace(1, {0.6F, 0.5F, 0.5F});
    bed.rebuild();
    ASSERT_EQ(bed.listed().size(), 1U);
    ASSERT_EQ(bed.idsOf(bed.listed()[0]), uvec2(1, 0));
    EXPECT_EQ(bed.remembered(bed.listed()[0]), vec3(-1, -2, -3));
    EXPECT_EQ(bed.rememberedTorque(bed.listed()[0]), vec3(4, 5, 6));
}

// A row of three whose last sphere goes away: the spheres of the lost contact no longer hold its impulse.
TEST(KernelsAsCpp, LostContactIsForgottenByItsSpheres) {
    Bed bed({vec4(0, 0, 0, 0.5F), vec4(0.9F, 0, 0, 0.5F), vec4(1.8F, 0, 0, 0.5F)},
            Feature::FRICTION | Feature::BALANCED | Feature::CONTACTS);
    bed.setMass(1, 2);
    bed.rebuild();
    ASSERT_EQ(bed.listed().size(), 2U);
    for (const uint k : bed.listed()) {
        const float direction = bed.idsOf(k).x < bed.idsOf(k).y ? -1 : 1;
        bed.remember(k, {direction, 0, 0}, {0, 0, 0.25F});
    }
    bed.addUpHeld();
    const auto held = [&](uint id) { return bed.heldVelocity(bed.slotOf(id)).x; };
    const auto spin = [&](uint id) { return bed.heldSpin(bed.slotOf(id)).z; };
    EXPECT_EQ(held(0), -1);
    EXPECT_EQ(held(1), 0) << "pressed from both sides";
    EXPECT_EQ(held(2), 1);
    EXPECT_EQ(spin(0), -2.5F * 0.25F / 0.5F);
    EXPECT_EQ(spin(1), 2 * spin(0) / 2);
    bed.setPlace(2, {0, 3, 0});
    bed.rebuild();
    EXPECT_EQ(bed.counters[COUNTER_CARRIED], 2U);
    EXPECT_EQ(bed.counters[COUNTER_RESTORED], 1U);
    EXPECT_EQ(held(0), -1);
    EXPECT_EQ(held(1), 0.5F);
    EXPECT_EQ(held(2), 0);
    EXPECT_EQ(spin(2), 0);
    bed.setPlace(2, {1.8F, 0, 0});
    bed.rebuild();
    const auto after = remembered(bed);
    ASSERT_EQ(after.size(), 2U);
    EXPECT_EQ(after.at({0, 1}), (Memory{vec3(-1, 0, 0), vec3(0, 0, 0.25F)}));
    EXPECT_EQ(after.at({1, 2}), (Memory{vec3(0), vec3(0)})) << "a new contact remembers nothing";
}

// Without lists there is no memory. Spheres do not hold what they lack.
TEST(KernelsAsCpp, WithoutListsContactsForget) {
    Bed bed({vec4(-2, 0, 0, 0.5F), vec4(-1.1F, 0, 0, 0.5F), vec4(3, 0, 0, 0.5F), vec4(3, 3, 0, 0.5F)},
            Feature::BALANCED | Feature::CONTACTS);
    bed.parameters.pairCapacity = 2 * PAIR_PADDING;  // room for one bundle
    bed.rebuild();
    ASSERT_EQ(bed.listed().size(), 1U);
    bed.holdAll(1);
    ASSERT_EQ(std::abs(bed.heldVelocity(bed.slotOf(0)).x), 1);
    bed.setPlace(3, {3.9F, 0, 0});
    bed.rebuild();
    ASSERT_TRUE(bed.listed().empty());
    for (uint slot = 0; slot < bed.count; ++slot) EXPECT_EQ(bed.heldVelocity(slot), vec3(0));
}

// 40 spheres in one place own up to 39 contacts. Those that own too many lose all: which of them have room depends on
// the order of the threads.
TEST(KernelsAsCpp, CrowdLosesTheContactsOfSpheresThatOwnTooMany) {
    std::vector<vec4> places(40, vec4(0.5F, 0.5F, 0.5F, 0.5F));
    for (std::size_t k = 0; k < places.size(); ++k) places[k].x += 1e-3F * static_cast<float>(k);
    Bed bed(places, Feature::BALANCED | Feature::CONTACTS | Feature::FRICTION);
    bed.rebuild();
    ASSERT_EQ(bed.listed().size(), 780U);
    for (const uint k : bed.listed()) bed.remember(k, {1, 0, 0});
    bed.rebuild();
    EXPECT_EQ(bed.counters[COUNTER_CARRIED], 780U);
    std::map<uint, uint> kept;  // by owner
    for (const auto& [ids, memory] : remembered(bed)) {
        if (memory.value == vec3(0)) continue;
        EXPECT_EQ(std::abs(memory.value.x), 1);
        ++kept[ids.first];
    }
    uint all = 0;
    for (uint id = 0; id < 40; ++id) {
        EXPECT_EQ(kept[id], 39 - id <= CARRIED_MOST ? 39 - id : 0) << id;
        all += kept[id];
    }
    EXPECT_EQ(bed.counters[COUNTER_RESTORED], all);
    // The spheres hold what the kept contacts hold.
    const auto unheld = bed.unheldVelocity;
    bed.addUpHeld();
    EXPECT_EQ(unheld, bed.unheldVelocity);
}

// A contact bears the same force in substeps of another length.
TEST(KernelsAsCpp, MemoryIsScaledToTheSubstep) {
    for (const std::uint64_t friction : {std::uint64_t{0}, std::uint64_t{Feature::FRICTION}}) {
        Bed bed(cluster(), Feature::BALANCED | Feature::CONTACTS | friction);
        bed.rebuild();
        rememberAtRandom(bed, true);
        for (std::size_t k = 0; k < bed.wallImpulse.size(); ++k) {
            bed.wallImpulse[k] = vec4(1, 2, 3, static_cast<float>(k % 3));
            bed.wallTorque[k] = vec4(4, 5, 6, 0);
        }
        bed.addUpHeld();
        bed.begin();  // the own acceleration follows what is held
        for (uint id = 0; id < bed.count; ++id) {
            bed.setVelocity(id, {0.5F, -0.25F, 1});
            bed.setSpin(id, {-2, 1, 0.5F});
        }
        bed.addUpHeld();
        const Bed before = bed;
        bed.parameters.substepRatio = 0.5F;
        bed.run("scale_pairs");
        bed.run("scale_spheres");
        const float turned = friction != 0 ? 0.5F : 1;
        for (const uint k : bed.listed()) {
            EXPECT_EQ(bed.remembered(k), 0.5F * before.remembered(k));
            EXPECT_EQ(bed.rememberedTorque(k), turned * before.rememberedTorque(k));
        }
        for (std::size_t k = 0; k < bed.wallImpulse.size(); ++k) {
            EXPECT_EQ(bed.wallImpulse[k], vec4(0.5F, 1, 1.5F, static_cast<float>(k % 3)));
            EXPECT_EQ(vec3(bed.wallTorque[k]), turned * vec3(4, 5, 6));
        }
        for (uint slot = 0; slot < bed.count; ++slot) {
            EXPECT_EQ(bed.ownAcceleration(slot), 0.5F * before.ownAcceleration(slot));
            EXPECT_NE(bed.ownAcceleration(slot), vec3(0));
            EXPECT_LT(glm::distance(bed.heldVelocity(slot), 0.5F * before.heldVelocity(slot)), 2e-6F);
            EXPECT_LT(glm::distance(bed.heldSpin(slot), turned * before.heldSpin(slot)), 2e-5F);
        }
        const Bed scaled = bed;
        bed.addUpHeld();
        for (uint slot = 0; slot < bed.count; ++slot)
            EXPECT_LT(glm::distance(bed.heldVelocity(slot), scaled.heldVelocity(slot)), 2e-6F);
    }
}

// The rows of walls belong to ids. The ids of the spheres that are left exceed their number after others have gone.
TEST(KernelsAsCpp, WallMemoryIsScaledById) {
    Bed bed({vec4(0, 0, 0, 0.5F), vec4(2, 0, 0, 0.5F)}, Feature::BALANCED | Feature::CONTACTS);
    for (vec4& row : bed.wallImpulse) row = vec4(1, 2, 3, 1);
    bed.idAndMaterial[0] = 1;
    bed.parameters.spheres = 1;
    bed.parameters.substepRatio = 0.5F;
    bed.run("scale_spheres");
    const auto rows = bed.parameters.maxWallHistory;
    for (uint k = 0; k < rows; ++k) {
        EXPECT_EQ(bed.wallImpulse[k], vec4(1, 2, 3, 1)) << "of no sphere";
        EXPECT_EQ(bed.wallImpulse[rows + k], vec4(0.5F, 1, 1.5F, 1));
    }
}

TEST(KernelsAsCpp, SlipAccumulatesUntilTheContactEnds) {
    Bed bed({vec4(0, 0, 0, 0.5F), vec4(0.99F, 0, 0, 0.5F)}, Feature::ACCURATE | Feature::FRICTION | Feature::LOW_BITS);
    bed.parameters.contact = vec4(1, 100, 0, 0);
    bed.parameters.stiffness = vec4(1e5F, 0, 3e4F, 0);
    bed.rebuild();
    bed.setVelocity(0, {0, 0.1F, 0});
    bed.setSpin(1, {0, 0, 0.5F});
    const auto press = [&bed] { bed.sweep("solve_forces"); };
    // The surface of the second sphere moves towards -y with 0.5 rad/s times the arm. slip() uses the radius of 0.5 m,
    // which gives 0.25 m/s. The kernel uses the distance to the contact point, 0.495 m, which gives 0.2475 m/s.
    ASSERT_NEAR(bed.slip(0, 1).y, 0.35F, 1e-6F);
    for (float substeps = 1; substeps < 4; ++substeps) {
        press();
        EXPECT_NEAR(remembered(bed).at({0, 1}).value.y, substeps * 0.3475F * bed.parameters.substep, 1e-8F);
    }
    bed.setPlace(1, {1.01F, 0, 0});
    press();
    EXPECT_EQ(remembered(bed).at({0, 1}).value, vec3(0));
}

TEST(KernelsAsCpp, SlipIsLimitedByFriction) {
    Bed bed({vec4(0, 0, 0, 0.5F), vec4(0.99F, 0, 0, 0.5F)}, Feature::ACCURATE | Feature::FRICTION | Feature::LOW_BITS);
    const float friction = 0.3F;
    bed.parameters.contact = vec4(1, friction, 0, 0);
    bed.parameters.stiffness = vec4(1e5F, 0, 3e4F, 0);
    bed.rebuild();
    bed.setVelocity(0, {0, 100, 0});
    bed.sweep("solve_forces");
    // The normal force is 2 Y R * 0.01 m, the tangential force 2 G R * slip. The slip is limited to the one that
    // friction can hold.
    EXPECT_NEAR(remembered(bed).at({0, 1}).value.y, friction * 1e5F / 3e4F * 0.01F, 1e-6F);
}

}  // namespace
}  // namespace spherule::kernels
