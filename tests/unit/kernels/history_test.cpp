// The slip of contacts, which the model `accurate` keeps from substep to substep.
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

// Returns the slip of the sphere with the lower id relative to the other one.
vec4 seenByTheLower(const Bed& bed, uint pair) {
    const uvec2 ids = bed.idsOf(pair);
    const vec4 one = bed.tangentialSlip[pair];
    return ids.x < ids.y ? one : vec4(-vec3(one), one.w);
}

std::map<Ids, vec4> remembered(const Bed& bed) {
    std::map<Ids, vec4> found;
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

// Gives a random slip to two thirds of the pairs.
void slipAtRandom(Bed& bed) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> slip(-1e-3F, 1e-3F);
    for (const uint k : bed.listed())
        bed.tangentialSlip[k] = random() % 3 == 0 ? vec4(0) : vec4(slip(random), slip(random), slip(random), 1);
}

// Mirrors all positions at the origin. Distances stay exactly the same, but almost all spheres change their slots.
void mirror(Bed& bed) {
    for (uint id = 0; id < bed.count; ++id) bed.setPlace(id, -bed.at(id));
}

TEST(KernelsAsCpp, ContactsKeepTheirHistoryAfterARebuild) {
    for (const std::uint64_t features : {std::uint64_t{0}, std::uint64_t{Feature::RADII}}) {
        Bed bed(cluster(), Feature::FRICTION | Feature::LOW_BITS | features);
        for (uint id = 0; id < bed.count; ++id) bed.setSpin(id, vec3(static_cast<float>(id)));
        bed.rebuild();
        slipAtRandom(bed);
        const auto before = remembered(bed);
        const uint lowerFirst = pairsWhoseFirstIsTheLower(bed);
        ASSERT_GT(before.size(), 100U);
        mirror(bed);
        bed.rebuild();
        EXPECT_EQ(remembered(bed), before);
        EXPECT_NE(pairsWhoseFirstIsTheLower(bed), lowerFirst) << "no pair has changed its order: the test is vacuous";
        for (uint id = 0; id < bed.count; ++id) EXPECT_EQ(bed.spinOf(id), vec3(static_cast<float>(id)));
    }
}

TEST(KernelsAsCpp, SlipChangesSignWhenAPairIsReversed) {
    Bed bed({vec4(0.6F, 0.5F, 0.5F, 0.5F), vec4(1.5F, 0.5F, 0.5F, 0.5F)}, Feature::FRICTION);
    bed.rebuild();
    ASSERT_EQ(bed.listed().size(), 1U);
    const uint k = bed.listed()[0];
    ASSERT_EQ(bed.idsOf(k), uvec2(0, 1));
    bed.tangentialSlip[k] = vec4(1, 2, 3, 1);
    bed.setPlace(0, {1.5F, 0.5F, 0.5F});
    bed.setPlace(1, {0.6F, 0.5F, 0.5F});
    bed.rebuild();
    ASSERT_EQ(bed.listed().size(), 1U);
    ASSERT_EQ(bed.idsOf(bed.listed()[0]), uvec2(1, 0));
    EXPECT_EQ(bed.tangentialSlip[bed.listed()[0]], vec4(-1, -2, -3, 1));
}

TEST(KernelsAsCpp, NewPairHasNoHistory) {
    Bed bed({vec4(0, 0, 0, 0.5F), vec4(0.9F, 0, 0, 0.5F), vec4(1.8F, 0, 0, 0.5F)}, Feature::FRICTION);
    bed.rebuild();
    ASSERT_EQ(bed.listed().size(), 2U);
    for (const uint k : bed.listed()) bed.tangentialSlip[k] = vec4(1, 2, 3, 1);
    bed.setPlace(2, {0, 3, 0});
    bed.rebuild();
    EXPECT_EQ(remembered(bed).size(), 1U);
    bed.setPlace(2, {1.8F, 0, 0});
    bed.rebuild();
    const auto after = remembered(bed);
    ASSERT_EQ(after.size(), 2U);
    EXPECT_EQ(glm::length(vec3(after.at({0, 1}))), glm::length(vec3(1, 2, 3)));
    EXPECT_EQ(after.at({0, 1}).w, 1);
    EXPECT_EQ(after.at({1, 2}), vec4(0));
}

TEST(KernelsAsCpp, SlipAccumulatesUntilTheContactEnds) {
    Bed bed({vec4(0, 0, 0, 0.5F), vec4(0.99F, 0, 0, 0.5F)}, Feature::FRICTION | Feature::LOW_BITS);
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
        const vec4 one = remembered(bed).at({0, 1});
        EXPECT_NEAR(one.y, substeps * 0.3475F * bed.parameters.substep, 1e-8F);
        EXPECT_EQ(one.w, 1);
    }
    bed.setPlace(1, {1.01F, 0, 0});
    press();
    EXPECT_EQ(remembered(bed).at({0, 1}), vec4(0));
}

TEST(KernelsAsCpp, SlipIsLimitedByFriction) {
    Bed bed({vec4(0, 0, 0, 0.5F), vec4(0.99F, 0, 0, 0.5F)}, Feature::FRICTION | Feature::LOW_BITS);
    const float friction = 0.3F;
    bed.parameters.contact = vec4(1, friction, 0, 0);
    bed.parameters.stiffness = vec4(1e5F, 0, 3e4F, 0);
    bed.rebuild();
    bed.setVelocity(0, {0, 100, 0});
    bed.sweep("solve_forces");
    // The normal force is 2 Y R * 0.01 m, the tangential force 2 G R * slip. The slip is limited to the one that
    // friction can hold.
    EXPECT_NEAR(remembered(bed).at({0, 1}).y, friction * 1e5F / 3e4F * 0.01F, 1e-6F);
}

}  // namespace
}  // namespace spherule::kernels
