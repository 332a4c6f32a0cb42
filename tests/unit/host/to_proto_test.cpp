#include "host/to_proto.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "host_support.h"

namespace spherule::host {
namespace {

v1::Refused refusalOf(const v1::Command& command, const std::string& where) {
    const auto result = resultOf(command, fail(ErrorKind::Refused, where, "is wrong"));
    EXPECT_TRUE(result.has_refused());
    return result.refused();
}

TEST(ResultOf, FieldPathStartsWithTheCommand) {
    v1::Command command;
    command.mutable_set();
    EXPECT_EQ(refusalOf(command, "gravity[1]").field(), "set.gravity[1]");
    EXPECT_EQ(refusalOf(command, "auto.budgetMs").field(), "set.auto.budgetMs");
    EXPECT_EQ(refusalOf(command, "auto.budgetMs").reason(), "is wrong");
    command.mutable_load();
    EXPECT_EQ(refusalOf(command, "scene.groups[0].fill").field(), "load.scene.groups[0].fill");
}

TEST(ResultOf, PathOutsideTheCommandIsPartOfTheReason) {
    v1::Command command;
    command.mutable_set();
    EXPECT_EQ(refusalOf(command, "materials[0].young").field(), "");
    EXPECT_EQ(refusalOf(command, "materials[0].young").reason(), "materials[0].young: is wrong");
    EXPECT_EQ(refusalOf(command, "").reason(), "is wrong");
}

TEST(ResultOf, ReplacesInvalidUtf8) {
    v1::Command command;
    command.mutable_pause();
    EXPECT_EQ(refusalOf(command, "a\xff.json").reason(), "a\xef\xbf\xbd.json: is wrong");
}

// The refusals of a command, as clients receive them.
TEST(ResultOf, RefusalsOfTheHostHavePathsFromTheCommand) {
    auto world = SimulationHost::open("cpu:1", "cradle", {});
    ASSERT_TRUE(world);
    const auto refused = [&](const v1::Command& command) {
        auto applied = give(**world, command);
        while (!applied) applied = (*world)->advanceChange(std::chrono::milliseconds(10));
        const auto result = resultOf(command, *applied);
        EXPECT_TRUE(result.has_refused()) << command.ShortDebugString();
        return result.refused().field();
    };
    v1::Command command;
    command.mutable_set()->set_speed(-1);
    EXPECT_EQ(refused(command), "set.speed");
    command.mutable_set()->Clear();
    command.mutable_set()->set_friction(std::nan(""));
    EXPECT_EQ(refused(command), "set.friction");
    command.mutable_set()->Clear();
    command.mutable_set()->set_substeps(0);
    EXPECT_EQ(refused(command), "set.substeps");
    command.mutable_set()->Clear();
    command.mutable_set()->add_gravity(1);
    EXPECT_EQ(refused(command), "set.gravity");
    command.mutable_step();
    EXPECT_EQ(refused(command), "step.count");
    command.mutable_load()->set_name("nothing");
    EXPECT_EQ(refused(command), "load.name");
    command.mutable_load()->mutable_scene();
    EXPECT_EQ(refused(command), "load.scene.bounds");
    command.mutable_spawn()->mutable_group();
    EXPECT_EQ(refused(command), "spawn.group");
    command.mutable_push()->set_sphere(99);
    for (int axis = 0; axis < 3; ++axis) command.mutable_push()->add_impulse(1);
    EXPECT_EQ(refused(command), "push.sphere");
}

TEST(ResultOf, ContainsTheHitSphereOrTheStatistics) {
    v1::Command command;
    command.set_id(7);
    const v1::CommandResult hit = resultOf(command, sim::Applied{.step = 3, .sphere = 0});
    EXPECT_EQ(hit.id(), 7U);
    EXPECT_EQ(hit.applied().step(), 3U);
    EXPECT_TRUE(hit.applied().has_sphere());
    EXPECT_FALSE(hit.applied().has_statistics());
    sim::Statistics statistics;
    statistics.step = 3;
    statistics.time = 0.05;
    statistics.spheres = 2;
    const v1::CommandResult asked = resultOf(command, sim::Applied{.step = 3, .statistics = statistics});
    EXPECT_FALSE(asked.applied().has_sphere());
    EXPECT_EQ(asked.applied().statistics().step(), 3U);
    EXPECT_EQ(asked.applied().statistics().sim_time(), 0.05);
    EXPECT_EQ(asked.applied().statistics().spheres(), 2U);
}

TEST(StatisticsMessage, HasNoRestitutionWithoutImpacts) {
    sim::Statistics statistics;
    EXPECT_FALSE(statisticsMessage(statistics).has_restitution());
    EXPECT_FALSE(statisticsMessage(statistics).has_restitution_asked());
    statistics.impacts = {.count = 2, .approach = 4, .parting = 2, .asked = 3};
    const v1::Statistics message = statisticsMessage(statistics);
    EXPECT_EQ(message.impacts(), 2U);
    EXPECT_EQ(message.restitution(), 0.5);
    EXPECT_EQ(message.restitution_asked(), 0.75);
}

}  // namespace
}  // namespace spherule::host
