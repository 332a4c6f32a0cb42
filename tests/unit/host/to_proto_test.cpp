#include "host/to_proto.h"
#include "host/facts_message.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

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

// Clients say by the cause and the limits what to do.
TEST(ResultOf, RefusalsOfTheHostHaveACauseAndLimits) {
    auto world = SimulationHost::open("cpu:1", "billiards", {});
    ASSERT_TRUE(world);
    const auto refused = [&](const std::string& json) {
        v1::Command command;
        EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(json, &command).ok()) << json;
        auto applied = give(**world, command);
        while (!applied) applied = (*world)->advanceChange(std::chrono::milliseconds(10));
        const auto result = resultOf(command, *applied);
        EXPECT_TRUE(result.has_refused()) << json;
        return result.refused();
    };
    struct Case {
        std::string json;
        v1::Refused::Cause cause;
        double least, most;  // NaN: absent
    };
    const double none = std::nan("");
    const std::string fill = R"({"spawn":{"group":{"radius":{"constant":0.1},"fill":{"min":[0,0,0],"max":)";
    const std::vector<Case> cases = {
        {R"({"set":{"speed":5000}})", v1::Refused::RANGE, 0.001, 1000},
        {R"({"set":{"friction":-1}})", v1::Refused::RANGE, 0, 100},
        {R"({"set":{"restitution":2}})", v1::Refused::RANGE, 0, 1},
        {R"({"set":{"gravity":[0,0,-2e6]}})", v1::Refused::RANGE, none, 1e6},
        {R"({"set":{"auto":{"overlap":0.9}}})", v1::Refused::RANGE, 1e-6, 0.5},
        {R"({"set":{"auto":{"budgetMs":-1}}})", v1::Refused::RANGE, 0, none},
        {R"({"step":{"count":0}})", v1::Refused::RANGE, 1, 100'000},
        {R"({"load":{"name":"nothing"}})", v1::Refused::NO_SUCH_SCENE, none, none},
        {R"({"push":{"sphere":999,"impulse":[0,0,1]}})", v1::Refused::NO_SUCH_SPHERE, none, none},
        {R"({"push":{"ray":{"origin":[0,0,9],"direction":[0,0,1]},"impulse":[0,0,1]}})", v1::Refused::NO_HIT, none,
         none},
        {fill + R"([1,0.7,0.15],"count":1}}}})", v1::Refused::TOO_LARGE, none, 0.075},
        {fill + R"([1,0.7,0.4],"count":1000}}}})", v1::Refused::NO_ROOM, none, 42},
        {R"({"spawn":{"group":{"radius":{"constant":2e6},"fill":{"max":[1,1,1],"count":1}}}})", v1::Refused::RANGE,
         1e-6, 1e6},
    };
    for (const Case& one : cases) {
        const v1::Refused refusal = refused(one.json);
        EXPECT_EQ(refusal.cause(), one.cause) << one.json << ": " << refusal.reason();
        const auto text = [](bool present, double value) { return present ? fmt::format("{:.6g}", value) : "absent"; };
        EXPECT_EQ(text(refusal.has_least(), refusal.least()), text(!std::isnan(one.least), one.least)) << one.json;
        EXPECT_EQ(text(refusal.has_most(), refusal.most()), text(!std::isnan(one.most), one.most)) << one.json;
    }
}

// The settings tell the largest impulse; it is taken, and a larger one is refused with this limit.
TEST(ResultOf, TheLargestImpulseOfTheSettingsIsTaken) {
    auto world = SimulationHost::open("cpu:1", "billiards", {});
    ASSERT_TRUE(world);
    (*world)->change(sim::Set{.gravity = glm::dvec3(0)});
    const double most = (*world)->settings().settings().max_impulse();
    ASSERT_GT(most, 0);
    const auto push = [&](double impulse) {
        v1::Command command;
        command.mutable_push()->set_sphere(5);
        for (const double part : {impulse, 0.0, 0.0}) command.mutable_push()->add_impulse(part);
        return resultOf(command, *give(**world, command));
    };
    const v1::CommandResult refused = push(1.01 * most);
    EXPECT_EQ(refused.refused().field(), "push.impulse");
    EXPECT_EQ(refused.refused().cause(), v1::Refused::RANGE);
    EXPECT_NEAR(refused.refused().most(), most, 1e-6 * most);
    EXPECT_TRUE(push(0.999 * most).has_applied());
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

TEST(FactsMessage, NamesTheMaterialsOfGroups) {
    auto world = SimulationHost::open("cpu:1", "billiards", {});
    ASSERT_TRUE(world);
    const v1::SceneFacts facts = factsMessage((*world)->simulation(), 1).scene();
    const std::vector<std::string> names(facts.materials().begin(), facts.materials().end());
    EXPECT_EQ(names, (std::vector<std::string>{"ball", "cloth", "cushion"}));
    for (const v1::GroupFacts& group : facts.groups()) EXPECT_EQ(group.material(), 0U) << group.name();
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
