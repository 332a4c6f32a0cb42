#include "encode/places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "scene/random.h"

namespace spherule::encode {
namespace {

using Numbers = std::vector<std::uint32_t>;

TEST(Places, HaveRoomAndStartWithTheRanks) {
    const sim::Population population(100);
    Places places(population);
    EXPECT_EQ(places.count(), 192U);
    ASSERT_EQ(places.inUse().size(), 1U);
    EXPECT_EQ(places.inUse()[0].count, 100U);
    Numbers reversed(100);
    for (std::uint32_t k = 0; k < 100; ++k) reversed[k] = 99 - k;
    places.setOrder(reversed);
    const Numbers handles = places.handles(population);
    for (std::uint32_t k = 0; k < 100; ++k) EXPECT_EQ(handles[k], 99 - k);
    EXPECT_EQ(handles[101], 0U) << "the values of the sphere before it";
    EXPECT_EQ(Places::placesFor(1'000'000) % 64, 0U);
    EXPECT_GE(Places::placesFor(1'000'000), 1'062'500U);
}

TEST(Places, AreNeverMovedAndAreUsedAgain) {
    sim::Population population(10);
    Places places(population);
    population.remove(Numbers{2, 3, 7}, 0);
    auto change = places.follow(population);
    ASSERT_TRUE(change);
    ASSERT_EQ(change->removed.size(), 2U);
    EXPECT_EQ(change->removed[0].first, 2U);
    EXPECT_EQ(change->removed[0].count, 2U);
    EXPECT_EQ(change->removed[1].first, 7U);
    EXPECT_TRUE(change->added.empty());
    population.add(4, 9);
    change = places.follow(population);
    ASSERT_EQ(change->added.size(), 3U);
    EXPECT_EQ(change->added[0].first, 2U);
    EXPECT_EQ(change->added[0].id, 10U);
    EXPECT_EQ(change->added[1].first, 7U);
    EXPECT_EQ(change->added[2].first, 10U);
    EXPECT_EQ(change->added[2].id, 13U);
}

TEST(Places, RunOut) {
    sim::Population population(10);
    Places places(population);
    population.add(places.count() - 10, 0);
    EXPECT_TRUE(places.follow(population));
    population.add(1, 0);
    EXPECT_FALSE(places.follow(population));
}

// Against a map from places to ids: each sphere's values come from its own handle, and free places show a present
// sphere.
TEST(Places, FollowRandomChanges) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        scene::Random random(seed);
        sim::Population population(300);
        Places places(population);
        std::map<std::uint32_t, std::uint64_t> known;
        for (std::uint32_t rank = 0; rank < 300; ++rank) known[rank] = rank;
        for (std::uint64_t step = 0; step < 100; ++step) {
            std::set<std::uint32_t> chosen;
            for (int k = 0; k < 12; ++k)
                chosen.insert(static_cast<std::uint32_t>(random.uniform(0, population.count())));
            population.remove(Numbers(chosen.begin(), chosen.end()), step);
            population.add(static_cast<std::uint32_t>(random.uniform(0, 24)), step);
            const auto change = places.follow(population);
            if (!change) break;
            for (const PlaceRun& run : change->removed)
                for (std::uint32_t k = 0; k < run.count; ++k) ASSERT_EQ(known.erase(run.first + k), 1U);
            for (const PlaceRun& run : change->added)
                for (std::uint32_t k = 0; k < run.count; ++k)
                    ASSERT_TRUE(known.emplace(run.first + k, run.id + k).second);
            ASSERT_EQ(known.size(), population.count());
            const Numbers handles = places.handles(population);
            for (std::uint32_t k = 0; k < places.count(); ++k) {
                const auto used = known.find(places.order()[k]);
                const std::uint32_t rank = population.rankOfHandle(handles[k]);
                ASSERT_LT(rank, population.count());
                if (used == known.end()) continue;
                ASSERT_EQ(population.idAt(rank), used->second);
            }
        }
    }
}

}  // namespace
}  // namespace spherule::encode
