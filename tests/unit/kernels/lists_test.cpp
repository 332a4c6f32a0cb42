// The lists of pairs and their order: bundles, and batches within a bundle.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "kernels_bed.h"

namespace spherule::kernels {
namespace {

using Ids = std::pair<uint, uint>;  // the lower id first

Ids idsOf(const Bed& bed, uint place) {
    return std::minmax(bed.idsOf(place).x, bed.idsOf(place).y);
}

// 343 spheres of 0.3 to 0.5 m on a jittered lattice, in random order: over 700 near pairs in all colours.
Bed crowdedBed(float jitterBy = 0.15F, uint seed = 4) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> jitter(-jitterBy, jitterBy);
    std::vector<vec4> places;
    for (uint k = 0; k < 343; ++k) {
        const vec3 corner(static_cast<float>(k % 7), static_cast<float>(k / 7 % 7), static_cast<float>(k / 49));
        const vec3 place = (corner - 3.0F) * 0.78F + vec3(jitter(random), jitter(random), jitter(random));
        places.emplace_back(place, 0.3F + 0.02F * static_cast<float>(random() % 11));
    }
    std::shuffle(places.begin(), places.end(), random);
    return Bed(places, Feature::RADII | Feature::CONTACTS | Feature::BALANCED);
}

std::set<Ids> nearPairs(const Bed& bed) {
    std::set<Ids> near;
    for (uint a = 0; a < bed.count; ++a)
        for (uint b = a + 1; b < bed.count; ++b)
            if (glm::distance(bed.at(a), bed.at(b)) < bed.radiusOf(a) + bed.radiusOf(b) + bed.parameters.margin)
                near.emplace(a, b);
    return near;
}

TEST(KernelsAsCpp, PairsWithinTheMarginAreListedOnce) {
    // 0 and 1 overlap; 1 and 2 are half a margin apart; 3 is alone; 0 and 4 are near across a cell border below the
    // origin.
    Bed bed({vec4(0.1F, 0, 0, 0.5F), vec4(1.0F, 0, 0, 0.5F), vec4(2.05F, 0, 0, 0.5F), vec4(0, 5, 0, 0.5F),
             vec4(-0.8F, 0, 0, 0.5F)});
    bed.rebuild();
    EXPECT_EQ(bed.counters[COUNTER_CANDIDATES], 3U);
    EXPECT_EQ(bed.counters[COUNTER_UNLISTED], 0U);
    std::multiset<Ids> listed;
    for (const uint place : bed.listed()) listed.insert(idsOf(bed, place));
    EXPECT_EQ(listed, (std::multiset<Ids>{{0, 1}, {0, 4}, {1, 2}}));
}

TEST(KernelsAsCpp, OrderHasEachNearPairOnce) {
    for (const uint seed : {4U, 5U, 6U}) {
        Bed bed = crowdedBed(0.15F, seed);
        bed.rebuild();
        std::multiset<Ids> listed;
        std::set<uint> places;
        for (const uint place : bed.listed()) {
            listed.insert(idsOf(bed, place));
            EXPECT_TRUE(places.insert(place).second) << place;
        }
        const std::set<Ids> near = nearPairs(bed);
        ASSERT_GT(near.size(), 700U);
        EXPECT_EQ(listed, std::multiset<Ids>(near.begin(), near.end()));
        EXPECT_EQ(bed.counters[COUNTER_CANDIDATES], near.size());
    }
}

TEST(KernelsAsCpp, PairsOfABatchShareNoSphere) {
    Bed bed = crowdedBed();
    bed.rebuild();
    std::map<std::pair<uint, uint>, std::multiset<uint>> slots;  // by bundle and batch
    std::map<uint, uint> pairsOfBatch;
    for (const Bed::Listed& one : bed.order()) {
        ASSERT_LT(one.batch, BATCHES) << "no sphere has so many neighbours here";
        ++pairsOfBatch[one.batch];
        for (const uint slot : {bed.pairs[one.place].x, SECOND_OF(bed.pairs[one.place])})
            slots[{one.bundle, one.batch}].insert(slot);
    }
    for (const auto& [batch, found] : slots)
        EXPECT_EQ(std::set<uint>(found.begin(), found.end()).size(), found.size()) << "batch " << batch.second;
    EXPECT_GE(pairsOfBatch.size(), HASHED_BATCHES) << "the hash chooses among all";
}

// Threads solve the bundles of a colour at the same time.
TEST(KernelsAsCpp, BlocksOfAColourShareNoSphere) {
    Bed bed = crowdedBed();
    // Cells of half the size, and spheres of a fifth: 64 blocks, 2 bundles of each colour.
    bed.parameters.cells = uvec4(16, 16, 16, 16 * 16 * 16);
    bed.parameters.levelCells[0] = uvec4(16, 16, 16, 0);
    bed.parameters.inverseCell = 2 / 1.1F;
    bed.parameters.levelSize[0] = vec4(2 / 1.1F, 0.25F, 64, 0);
    bed.parameters.levelBundles[0] = uvec4(0, 2, 0, 0);
    bed.parameters.bundles = 16;
    bed.cellStart.resize(bed.parameters.cells.w + 1);
    bed.groupRange.resize(bed.parameters.cells.w / 8);
    bed.bundles.assign(std::size_t{17} * BUNDLE_WORDS, 0);
    std::mt19937 random(9);
    std::uniform_real_distribution<float> coordinate(-4, 4);
    for (vec4& sphere : bed.position) sphere = vec4(coordinate(random), coordinate(random), coordinate(random), 0.22F);
    bed.rebuild();
    std::map<uint, std::map<uint, std::set<uint>>> slots;  // by colour, slot: the bundles that hold it
    for (const Bed::Listed& one : bed.order())
        for (const uint slot : {bed.pairs[one.place].x, SECOND_OF(bed.pairs[one.place])})
            slots[one.bundle / 2][slot].insert(one.bundle);
    EXPECT_EQ(slots.size(), 8U);
    std::size_t inBoth = 0;
    for (const auto& [colour, bySlot] : slots)
        for (const auto& [slot, holders] : bySlot) inBoth += holders.size() - 1;
    EXPECT_EQ(inBoth, 0U);
    std::multiset<Ids> listed;
    for (const uint place : bed.listed()) listed.insert(idsOf(bed, place));
    const std::set<Ids> near = nearPairs(bed);
    ASSERT_GT(near.size(), 50U);
    EXPECT_EQ(listed, std::multiset<Ids>(near.begin(), near.end()));
}

TEST(KernelsAsCpp, ClosePairsComeFirstInTheirBatch) {
    Bed bed = crowdedBed();
    bed.rebuild();
    std::map<std::pair<uint, uint>, bool> farSeen;
    uint mixed = 0;
    for (const Bed::Listed& one : bed.order()) {
        const uvec2 ids = bed.idsOf(one.place);
        const float gap = glm::distance(bed.at(ids.x), bed.at(ids.y)) - bed.radiusOf(ids.x) - bed.radiusOf(ids.y);
        const bool far = gap > 0.05F * std::min(bed.radiusOf(ids.x), bed.radiusOf(ids.y));
        bool& seen = farSeen[{one.bundle, one.batch}];
        EXPECT_FALSE(seen && !far) << "a close pair behind a far one";
        if (far && !seen) ++mixed;
        seen = seen || far;
    }
    EXPECT_GT(mixed, 20U) << "few batches have both";
}

// A sphere with more neighbours than there are batches: the pairs that remain come one by one, after all batches.
TEST(KernelsAsCpp, PairsWithoutAFreeBatchComeLast) {
    constexpr uint around = 100;
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    std::vector<vec4> places;
    places.emplace_back(0.55F, 0.55F, 0.55F, 0.45F);
    while (places.size() <= around) {
        const vec3 direction = glm::normalize(vec3(normal(random), normal(random), normal(random)));
        const vec4 place = places[0] + vec4(0.5F * direction, 0.001F - 0.45F);
        if (std::ranges::none_of(places, [&](const vec4& p) { return glm::distance(vec3(p), vec3(place)) < 0.06F; }))
            places.push_back(place);
    }
    Bed bed(places, Feature::RADII | Feature::CONTACTS | Feature::BALANCED);
    bed.parameters.margin = 0.05F;
    bed.parameters.levelSize[0].z = 1000;  // no sample
    bed.rebuild();
    ASSERT_EQ(bed.counters[COUNTER_CANDIDATES], around);
    std::map<std::pair<uint, uint>, uint> ofBatch;
    std::set<Ids> listed;
    std::map<uint, uint> ofBundle;
    for (const Bed::Listed& one : bed.order()) {
        listed.insert(idsOf(bed, one.place));
        ++ofBatch[{one.bundle, one.batch}];
        ++ofBundle[one.bundle];
    }
    EXPECT_EQ(listed.size(), around);
    uint single = 0;
    for (const auto& [bundle, number] : ofBundle) {
        // All pairs share sphere 0: one for each batch, and the rest is left over.
        for (uint batch = 0; batch < BATCHES; ++batch)
            EXPECT_LE((ofBatch[{bundle, batch}]), 1U) << "bundle " << bundle << ", batch " << batch;
        const uint left = number > BATCHES ? number - BATCHES : 0;
        EXPECT_EQ((ofBatch[{bundle, BATCHES}]), left) << "bundle " << bundle;
        single += left;
    }
    EXPECT_GT(single, 20U);
}

// The order of pairs hardly changes from list to list, although most spheres change their slots.
TEST(KernelsAsCpp, PairsKeepTheirBatchWhenListsAreRebuilt) {
    Bed bed = crowdedBed();
    bed.rebuild();
    std::map<Ids, uint> before;
    for (const Bed::Listed& one : bed.order()) before[idsOf(bed, one.place)] = one.batch;
    std::mt19937 random(8);
    std::uniform_real_distribution<float> motion(-0.02F, 0.02F);
    for (uint id = 0; id < bed.count; ++id)
        bed.setPlace(id, bed.at(id) + vec3(motion(random), motion(random), motion(random)));
    bed.rebuild();
    uint both = 0;
    uint kept = 0;
    for (const Bed::Listed& one : bed.order()) {
        const auto old = before.find(idsOf(bed, one.place));
        if (old == before.end()) continue;
        ++both;
        if (old->second == one.batch) ++kept;
    }
    ASSERT_GT(both, 600U);
    EXPECT_GT(kept, both * 3 / 4);
}

// A bundle's pairs are followed by unused ones, because a vector of lanes may reach beyond its last pair.
TEST(KernelsAsCpp, BundlesDoNotOverlapAndArePadded) {
    Bed bed = crowdedBed();
    bed.rebuild();
    std::map<uint, uint> ends;  // by first place
    for (uint bundle = 0; bundle < bed.parameters.bundles; ++bundle) {
        const uint* const words = &bed.bundles[std::size_t{bundle} * BUNDLE_WORDS];
        if (words[1] == 0) continue;
        EXPECT_EQ(words[4 + BATCHES], words[0] + words[1]);
        ends[words[0]] = words[0] + words[1];
    }
    ASSERT_GT(ends.size(), 4U);
    uint free = 0;
    for (const auto& [first, end] : ends) {
        EXPECT_GE(first, free);
        free = end + PAIR_PADDING;
    }
    EXPECT_LE(free, bed.parameters.pairCapacity);
    EXPECT_EQ(free, bed.counters[COUNTER_PAIRS]);
}

TEST(KernelsAsCpp, WithoutRoomForAllPairsNoBundleHasAList) {
    Bed bed = crowdedBed();
    bed.rebuild();
    const uint needed = bed.counters[COUNTER_PAIRS];
    for (const uint room : {needed - 1, bed.counters[COUNTER_CANDIDATES] - 1, 0U}) {
        bed.parameters.pairCapacity = room;
        bed.rebuild();
        EXPECT_TRUE(bed.order().empty()) << room;
        EXPECT_EQ(bed.counters[COUNTER_UNLISTED], bed.parameters.bundles);
        EXPECT_NE(bed.dispatchArgs[LAUNCH_UNLISTED].x, 0U);
    }
    bed.parameters.pairCapacity = needed;
    bed.rebuild();
    EXPECT_FALSE(bed.order().empty());
    EXPECT_EQ(bed.counters[COUNTER_UNLISTED], 0U);
    EXPECT_EQ(bed.dispatchArgs[LAUNCH_UNLISTED].x, 0U);
}

}  // namespace
}  // namespace spherule::kernels
