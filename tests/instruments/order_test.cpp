// Kernels give the same bits in any order of their work groups, and of the threads of a work group.
#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "faulty.h"
#include "runs.h"
#include "work_groups.h"

namespace spherule::instruments {
namespace {

Digest resultsIn(const Trial& trial, std::span<const Entry> table, std::uint64_t seed = 0) {
    const Chosen chosen(table, seed);
    return trial.results();
}

class Order : public testing::TestWithParam<Trial> {};

// 0 is the order by numbers.
void expectTheSameBits(const Trial& trial, std::initializer_list<std::uint64_t> seeds) {
    const Digest expected = resultsIn(trial, production());
    for (const std::uint64_t seed : seeds) EXPECT_EQ(resultsIn(trial, inWorkGroups(), seed), expected) << seed;
    for (const std::string& fault : takeBarrierFaults()) ADD_FAILURE() << fault;
    testing::Test::RecordProperty("launches", std::to_string(launches()));
}

TEST_P(Order, DoesNotChangeTheBits) {
    expectTheSameBits(GetParam(), {0, 1, 2});
}

class SceneOrder : public testing::TestWithParam<Trial> {};

TEST_P(SceneOrder, DoesNotChangeTheBits) {
    expectTheSameBits(GetParam(), {1});
}

INSTANTIATE_TEST_SUITE_P(Of, Order, testing::ValuesIn(mixtureTrials()),
                         [](const auto& parameter) { return parameter.param.name; });
INSTANTIATE_TEST_SUITE_P(Of, SceneOrder, testing::ValuesIn(sceneTrials()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(OrderCoverage, EveryKernelIsLaunched) {
    for (const Trial& trial : coveringTrials()) resultsIn(trial, inWorkGroups(), 3);
    EXPECT_EQ(neverLaunched(), std::vector<std::string>{});
    RecordProperty("launches", std::to_string(launches()));
}

std::vector<std::uint32_t> controlIn(std::string_view kernel, std::uint64_t seed) {
    const Chosen chosen(inWorkGroups(), seed);
    return launchControl(kernel);
}

TEST(OrderControl, PlacesByArrivalChangeTheBits) {
    EXPECT_NE(controlIn("places_by_arrival", 0), controlIn("places_by_arrival", 1));
    EXPECT_NE(controlIn("places_by_arrival", 1), controlIn("places_by_arrival", 2));
}

TEST(OrderControl, AMissingBarrierChangesTheBits) {
    EXPECT_NE(controlIn("without_barrier", 1), controlIn("without_barrier", 2));
}

TEST(OrderControl, BarriersKeepTheBits) {
    EXPECT_EQ(controlIn("coherent_across_barrier", 0), controlIn("coherent_across_barrier", 1));
}

TEST(OrderControl, ASimulationWithoutCellOrderChangesItsBits) {
    for (const Trial& trial : mixtureTrials()) {
        if (trial.name != "mixture_balanced" && trial.name != "crowd_fast") continue;
        EXPECT_NE(resultsIn(trial, withoutCellOrder(), 1), resultsIn(trial, withoutCellOrder(), 2)) << trial.name;
    }
}

TEST(OrderControl, ThreadsThatMissABarrierAreReported) {
    launchControl("ends_before_barrier");
    const std::vector<std::string> ended = takeBarrierFaults();
    ASSERT_EQ(ended.size(), 1U);
    EXPECT_TRUE(ended[0].starts_with("ends_before_barrier: 23 threads ended, thread 0 waits in line ")) << ended[0];
    launchControl("two_barriers");
    const std::vector<std::string> apart = takeBarrierFaults();
    ASSERT_EQ(apart.size(), 1U);
    EXPECT_TRUE(apart[0].starts_with("two_barriers: thread 0 waits in line ")) << apart[0];
}

}  // namespace
}  // namespace spherule::instruments
