// No two invocations of a launch race for a word of a buffer.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "faulty.h"
#include "races.h"
#include "runs.h"
#include "work_groups.h"

namespace spherule::instruments {
namespace {

class Races : public testing::TestWithParam<Trial> {};

TEST_P(Races, AreNone) {
    const Chosen chosen(inWorkGroups());
    GetParam().results();
    for (const Race& race : takeRaces()) ADD_FAILURE() << race.text();
    RecordProperty("launches", std::to_string(launches()));
    RecordProperty("accesses", std::to_string(accesses()));
}

INSTANTIATE_TEST_SUITE_P(Of, Races, testing::ValuesIn(mixtureTrials()),
                         [](const auto& parameter) { return parameter.param.name; });
INSTANTIATE_TEST_SUITE_P(OfScenes, Races, testing::ValuesIn(sceneTrials()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(RacesCoverage, EveryKernelIsWatched) {
    const Chosen chosen(inWorkGroups());
    for (const Trial& trial : coveringTrials()) trial.results();
    EXPECT_EQ(neverLaunched(), std::vector<std::string>{});
    EXPECT_GT(accesses(), 1'000'000U);
    RecordProperty("launches", std::to_string(launches()));
    RecordProperty("accesses", std::to_string(accesses()));
}

// Returns the races of a control, by the kinds of their accesses.
std::map<std::string, Race> racesOf(std::string_view control) {
    const Chosen chosen(inWorkGroups());
    launchControl(control);
    std::map<std::string, Race> races;
    for (Race& race : takeRaces()) {
        EXPECT_EQ(race.kernel, control);
        races[race.kind] = std::move(race);
    }
    return races;
}

testing::AssertionResult isRace(const Race& race, std::string_view buffer, bool inGroup) {
    if (race.buffer == buffer && race.inGroup == inGroup && race.first != race.second)
        return testing::AssertionSuccess();
    return testing::AssertionFailure() << race.text();
}

TEST(RacesControl, BetweenInvocationsAreReported) {
    const auto races = racesOf("reads_neighbour");
    const Race& race = races.at("read, write");  // of words 1 .. 63; word 0 is written before it is read
    EXPECT_TRUE(isRace(race, "values", false));
    EXPECT_EQ(race.first, 0U);
    EXPECT_EQ(race.second, 1U);
    EXPECT_EQ(race.word, 1U);
    EXPECT_EQ(race.count, 63U);
    EXPECT_EQ(races.at("write, read").word, 0U);
    EXPECT_EQ(race.text(), "reads_neighbour: read, write of values[word 1] by invocations 0 and 1, 63 times");
}

TEST(RacesControl, DoNotDependOnTheOrder) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const Chosen chosen(inWorkGroups(), seed);
        launchControl("reads_neighbour");
        std::uint64_t count = 0;
        for (const Race& race : takeRaces()) count += race.count;
        EXPECT_EQ(count, 64U);
    }
}

TEST(RacesControl, BetweenTwoWritersAreReported) {
    EXPECT_TRUE(isRace(racesOf("writes_one_word").at("write, write"), "values", false));
}

TEST(RacesControl, OfAtomicsWithOtherAccessesAreReported) {
    const auto races = racesOf("reads_counter");
    EXPECT_TRUE(isRace(races.at("atomic write, read"), "counter", false));
    EXPECT_TRUE(isRace(races.at("read, atomic write"), "counter", false));
    EXPECT_TRUE(racesOf("places_by_arrival").empty());
}

TEST(RacesControl, BetweenThreadsOfAWorkGroupAreReported) {
    EXPECT_TRUE(isRace(racesOf("without_barrier").at("read, write"), "", true));
    EXPECT_TRUE(isRace(racesOf("shares_sphere").at("write, read"), "values", true));
}

TEST(RacesControl, AcrossABarrierThatDoesNotOrderThemAreReported) {
    EXPECT_TRUE(isRace(racesOf("barrier_without_buffers").at("write, read"), "values", true));
    EXPECT_TRUE(isRace(racesOf("not_coherent").at("write, read"), "values", true));
    EXPECT_TRUE(racesOf("coherent_across_barrier").empty());
}

TEST(RacesControl, UseOfAVariableThatWasNeverSetIsReported) {
    const auto races = racesOf("reads_shared_before");
    EXPECT_EQ(races.at("read, never written").group, 0U);
    EXPECT_EQ(races.size(), 1U);
}

// Returns the races of the kernel that solves contacts, in a simulation with the faulty kernels.
std::vector<Race> racesOfSolver(std::span<const Entry> table) {
    const Chosen chosen(table);
    for (const Trial& trial : mixtureTrials())
        if (trial.name == "mixture_balanced") trial.results();
    std::vector<Race> races = takeRaces();
    std::erase_if(races, [](const Race& race) { return race.kernel != "solve_contacts.comp"; });
    return races;
}

TEST(RacesControl, OfPairsThatShareASphereInABatchAreReported) {
    const std::vector<Race> races = racesOfSolver(withBatchesJoined());
    ASSERT_FALSE(races.empty());
    for (const Race& race : races) EXPECT_TRUE(race.inGroup) << race.text();
}

TEST(RacesControl, OfBundlesThatShareASphereInAColourAreReported) {
    const std::vector<Race> races = racesOfSolver(withColoursJoined());
    ASSERT_FALSE(races.empty());
    for (const Race& race : races) EXPECT_FALSE(race.inGroup) << race.text();
    EXPECT_TRUE(std::ranges::any_of(races, [](const Race& race) { return race.buffer == "velocity"; }))
        << races[0].text();
}

}  // namespace
}  // namespace spherule::instruments
