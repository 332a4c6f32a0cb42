#include "sim/population.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "scene/random.h"

namespace spherule::sim {
namespace {

using Ranks = std::vector<std::uint32_t>;

TEST(Population, IsPlainUntilASphereIsRemoved) {
    Population population(3);
    population.add(2, 0);
    EXPECT_TRUE(population.plain());
    EXPECT_EQ(population.handleAt(4), 4U);
    EXPECT_EQ(population.idAt(4), 4U);
    EXPECT_TRUE(population.ranksByHandle().empty());
    population.remove(Ranks{1}, 0);
    EXPECT_FALSE(population.plain());
    EXPECT_EQ(population.count(), 4U);
    EXPECT_EQ(population.idAt(1), 2U);
    EXPECT_EQ(population.handleAt(1), 2U);
    EXPECT_FALSE(population.rankOf(1));
    EXPECT_TRUE(population.wasBorn(1));
    EXPECT_FALSE(population.wasBorn(5));
}

TEST(Population, UsesTheLowestFreeHandlesAfterTheirRest) {
    Population population(6);
    population.remove(Ranks{1, 4}, 10);
    EXPECT_EQ(population.add(1, 10 + Population::restSteps - 1), Ranks{6}) << "the others rest";
    EXPECT_EQ(population.add(3, 10 + Population::restSteps), (Ranks{1, 4, 7}));
    EXPECT_EQ(population.handles(), 8U);
    const Ranks ranks = population.ranksByHandle();
    EXPECT_EQ(ranks, (Ranks{0, 5, 1, 2, 6, 3, 4, 7}));
    EXPECT_EQ(population.rankOfHandle(4), 6U);
    EXPECT_EQ(population.idAt(6), 8U);
}

TEST(Population, ARemovedWorldHasNoHandlesOfOldSpheres) {
    Population population(2);
    population.remove(Ranks{0, 1}, 0);
    EXPECT_EQ(population.count(), 0U);
    population.add(2, 1);
    EXPECT_EQ(population.idAt(0), 2U);
    EXPECT_EQ(population.handleAt(0), 2U);
    EXPECT_EQ(population.born(), 4U);
    EXPECT_EQ(population.removed(), 2U);
}

TEST(Population, RenumbersHandlesAndKeepsIds) {
    Population population(4, 100);
    population.remove(Ranks{0, 2}, 0);
    population.renumber();
    EXPECT_EQ(population.handleAt(1), 1U);
    EXPECT_EQ(population.idAt(1), 103U);
    EXPECT_EQ(population.handles(), 2U);
    EXPECT_EQ(population.add(1, 50), Ranks{2});
    EXPECT_EQ(population.rankOf(104), 2U);
}

// Against a map from ids to handles.
TEST(Population, HoldsItsRulesInRandomRuns) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        scene::Random random(seed);
        Population population(50, (1U << 24U) - 60);
        std::map<std::uint64_t, std::uint32_t> expected;
        for (std::uint32_t rank = 0; rank < 50; ++rank) expected[population.idAt(rank)] = population.handleAt(rank);
        std::uint64_t next = (1U << 24U) - 10;
        for (std::uint64_t step = 0; step < 300; ++step) {
            if (random.uniform(0, 1) < 0.5) {
                for (const std::uint32_t handle :
                     population.add(static_cast<std::uint32_t>(random.uniform(0, 5)), step))
                    expected[next++] = handle;
            } else if (population.count() > 0) {
                std::set<std::uint32_t> chosen;
                for (int k = 0; k < 4; ++k)
                    chosen.insert(static_cast<std::uint32_t>(random.uniform(0, population.count())));
                const Ranks ranks(chosen.begin(), chosen.end());
                for (const std::uint32_t rank : ranks) expected.erase(population.idAt(rank));
                population.remove(ranks, step);
            }
            ASSERT_EQ(population.count(), expected.size());
            ASSERT_EQ(population.born(), population.count() + population.removed());
            std::set<std::uint32_t> handles;
            std::uint32_t rank = 0;
            for (const auto& [id, handle] : expected) {
                ASSERT_EQ(population.idAt(rank), id);
                ASSERT_EQ(population.handleAt(rank), handle);
                ASSERT_EQ(population.rankOf(id), rank);
                ASSERT_EQ(population.rankOfHandle(handle), rank);
                handles.insert(handle);
                ++rank;
            }
            ASSERT_EQ(handles.size(), expected.size());
        }
        EXPECT_LT(population.handles(), 400U);
    }
}

}  // namespace
}  // namespace spherule::sim
