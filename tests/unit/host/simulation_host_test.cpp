#include "host/simulation_host.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>
#include <glm/geometric.hpp>

#include "host_support.h"
#include "scene/quality.h"

namespace spherule::host {
namespace {

using namespace std::chrono_literals;
constexpr auto now = SimulationHost::Clock::time_point::min();  // a deadline in the past: each call does the least work

v1::Command commandOf(const std::string& json) {
    v1::Command command;
    EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(json, &command).ok()) << json;
    return command;
}

// Returns the result of a command that is carried out at once.
sim::Applied done(SimulationHost& world, const std::string& json) {
    const auto applied = give(world, commandOf(json));
    EXPECT_TRUE(applied && *applied) << json;
    return applied && *applied ? **applied : sim::Applied();
}

Error refusalOf(SimulationHost& world, const std::string& json) {
    const auto applied = give(world, commandOf(json));
    EXPECT_TRUE(applied && !*applied) << json;
    return applied && !*applied ? applied->error() : Error();
}

// Returns the number of pieces until the change has a result.
int piecesOf(SimulationHost& world, int most, Result<sim::Applied>& result) {
    for (int pieces = 1; pieces <= most; ++pieces) {
        if (auto applied = world.advanceChange(0ns)) {
            result = std::move(*applied);
            return pieces;
        }
    }
    ADD_FAILURE() << "not done after " << most << " pieces";
    return most;
}

std::unique_ptr<SimulationHost> open(const std::string& scene = "two-spheres") {
    auto world = SimulationHost::open("cpu:1", scene, {});
    EXPECT_TRUE(world) << world.error().text();
    return std::move(*world);
}

// A sphere in empty space that starts at z = 0 with an upward speed of 0.9 m/s.
constexpr const char* thrown =
    R"("bounds":{"min":[-9,-9,-9],"max":[9,9,9]},"groups":[{"radius":{"constant":0.05},"velocity":[0,0,0.9],
       "list":{"spheres":[{"position":[0,0,0]}]}}])";

void load(SimulationHost& world, const std::string& scene) {
    ASSERT_FALSE(give(world, commandOf(R"({"load":{"scene":{)" + scene + "}}}")));
    Result<sim::Applied> result;
    while (true) {
        auto applied = world.advanceChange(10ms);
        if (!applied) continue;
        ASSERT_TRUE(*applied) << applied->error().text();
        return;
    }
}

TEST(SimulationHost, AdvanceReturnsAfterEachSubstepOfALongStep) {
    const auto world = open();
    load(*world, thrown);
    done(*world, R"({"set":{"substeps":1000}})");
    sim::Simulation& simulation = world->simulation();
    for (int substeps = 1; substeps < 1000; ++substeps) {
        const auto ended = world->advance(now);
        ASSERT_TRUE(ended);
        ASSERT_FALSE(*ended) << substeps;
        EXPECT_TRUE(simulation.midStep());
        EXPECT_EQ(simulation.steps(), 0U);
        EXPECT_NEAR(simulation.time() / simulation.scene().step, substeps / 1000.0, 1e-12);
    }
    EXPECT_TRUE(*world->advance(now));
    EXPECT_EQ(simulation.steps(), 1U);
    EXPECT_EQ(simulation.time(), simulation.scene().step);
}

TEST(SimulationHost, PausesWithinAStepAndContinuesIt) {
    const auto world = open();
    load(*world, thrown);
    done(*world, R"({"set":{"substeps":100}})");
    for (int k = 0; k < 30; ++k) ASSERT_FALSE(*world->advance(now));
    done(*world, R"({"pause":{}})");
    EXPECT_FALSE(world->running());
    EXPECT_TRUE(world->simulation().midStep());
    done(*world, R"({"step":{"count":1}})");
    int left = 1;
    while (!*world->advance(now)) ++left;
    EXPECT_EQ(left, 70);
    EXPECT_FALSE(world->running());
    EXPECT_EQ(world->simulation().steps(), 1U);
}

// The step keeps its length when the number of substeps changes in the middle of it.
TEST(SimulationHost, SubstepsMayChangeWithinAStep) {
    for (const int before : {2, 7, 64, 999}) {
        for (const int after : {1, 3, 64, 1000}) {
            const auto world = open();
            load(*world, thrown);
            done(*world, fmt::format(R"({{"set":{{"substeps":{}}}}})", before));
            sim::Simulation& simulation = world->simulation();
            for (int k = 0; k < before / 2; ++k) ASSERT_FALSE(*world->advance(now));
            const double time = simulation.time();
            done(*world, fmt::format(R"({{"set":{{"substeps":{}}}}})", after));
            EXPECT_NEAR(simulation.time(), time, 1e-15);
            int substeps = 1;
            while (!*world->advance(now)) ++substeps;
            EXPECT_LE(substeps, after);
            EXPECT_EQ(simulation.steps(), 1U);
            const double t = simulation.scene().step;
            const sim::State state = simulation.snapshot();
            EXPECT_NEAR(sim::positionOf(state, 0).z, 0.9 * t - 9.81 / 2 * t * t, 2e-6) << before << " " << after;
            EXPECT_NEAR(sim::velocityOf(state, 0).z, 0.9 - 9.81 * t, 1e-4) << before << " " << after;
            // The next step has the new number of substeps.
            substeps = 1;
            while (!*world->advance(now)) ++substeps;
            EXPECT_EQ(substeps, after);
            EXPECT_EQ(simulation.time(), 2 * t);
        }
    }
}

TEST(SimulationHost, SimulatesWhileAnotherSceneLoads) {
    const auto world = open("box-4k");
    const std::uint32_t epoch = world->epoch();
    ASSERT_FALSE(give(*world, commandOf(R"({"load":{"name":"box-10k"}})")));
    int pieces = 0;
    while (true) {
        EXPECT_TRUE(world->changing());
        EXPECT_TRUE(world->running());
        const std::uint64_t steps = world->simulation().steps();
        while (!*world->advance(now)) {
        }
        EXPECT_EQ(world->simulation().steps(), steps + 1);
        EXPECT_EQ(world->simulation().count(), 4000U);
        ++pieces;
        const auto applied = world->advanceChange(0ns);
        if (!applied) continue;
        ASSERT_TRUE(*applied) << applied->error().text();
        break;
    }
    EXPECT_GT(pieces, 20);  // one for each array and each kernel
    EXPECT_NE(world->epoch(), epoch);
    EXPECT_EQ(world->simulation().count(), 10000U);
    EXPECT_EQ(world->simulation().steps(), 0U);
}

TEST(SimulationHost, CancelledLoadLeavesTheWorldUnchanged) {
    const auto world = open("two-spheres");
    const std::uint32_t epoch = world->epoch();
    const std::uint64_t hash = sim::hashOf(world->simulation().snapshot());
    for (const int pieces : {0, 1, 5, 30}) {
        ASSERT_FALSE(give(*world, commandOf(R"({"load":{"name":"box-4k"}})")));
        for (int k = 0; k < pieces; ++k) ASSERT_FALSE(world->advanceChange(0ns));
        world->cancelChange();
        EXPECT_FALSE(world->changing());
    }
    EXPECT_EQ(world->epoch(), epoch);
    EXPECT_EQ(sim::hashOf(world->simulation().snapshot()), hash);
}

// While spheres are added, the others must not move, because new spheres must not overlap them.
TEST(SimulationHost, DoesNotMoveSpheresWhileOthersAreAdded) {
    const auto world = open("two-spheres");
    while (!*world->advance(now)) {
    }
    const std::uint64_t hash = sim::hashOf(world->simulation().snapshot());
    const std::uint64_t steps = world->simulation().steps();
    ASSERT_FALSE(give(
        *world,
        commandOf(
            R"({"spawn":{"group":{"radius":{"constant":0.01},"fill":{"min":[0,0,0],"max":[0.1,0.1,0.1],"count":3}}}})")));
    EXPECT_FALSE(world->running());
    Result<sim::Applied> result;
    EXPECT_GT(piecesOf(*world, 1'000'000'000, result), 10);
    ASSERT_TRUE(result) << result.error().text();
    EXPECT_TRUE(world->running());
    EXPECT_EQ(world->simulation().steps(), steps);
    EXPECT_EQ(world->simulation().count(), 5U);
    sim::State state = world->simulation().snapshot();
    state.position.resize(2);
    state.velocity.resize(2);
    state.spin.resize(2);
    EXPECT_EQ(sim::hashOf(state), hash);
}

// Each sweep is a piece, and so is the check after every 16 sweeps.
TEST(SimulationHost, SeparatesSpheresAtOnePointInPieces) {
    const auto world = open("two-spheres");
    ASSERT_FALSE(give(*world, commandOf(R"({"load":{"scene":{"bounds":{"min":[-1,-1,-1],"max":[1,1,1]},
        "groups":[{"radius":{"constant":0.02},
                   "lattice":{"min":[-0.1,-0.1,-0.1],"max":[0.1,0.1,0.1],"spacing":1e-6,"count":300}}]}}})")));
    Result<sim::Applied> result;
    EXPECT_GT(piecesOf(*world, 1'000'000'000, result), 60);
    ASSERT_TRUE(result) << result.error().text();
    EXPECT_EQ(world->simulation().count(), 300U);
    EXPECT_FALSE(world->simulation().takeNotices().empty());
}

TEST(SimulationHost, AcceptsAtMostTheSubstepLimitOfTheScene) {
    const auto world = open("box-4k");
    const std::uint32_t most = scene::maxSubstepsFor(world->simulation().scene());
    const Error refused = refusalOf(*world, R"({"set":{"substeps":1000000}})");
    EXPECT_NE(refused.message.find(fmt::format("1 to {}", most)), std::string::npos) << refused.text();
    refusalOf(*world, fmt::format(R"({{"set":{{"substeps":{}}}}})", most + 1));
    done(*world, fmt::format(R"({{"set":{{"substeps":{}}}}})", most));
    EXPECT_EQ(world->simulation().substeps(), most);
}

// With more spheres, fewer substeps are accepted, so that the work of a step is limited.
TEST(SimulationHost, WorkOfAStepIsLimitedForAnyNumberOfSpheres) {
    scene::Scene scene;
    scene.bounds = {.min = glm::dvec3(-10), .max = glm::dvec3(10)};
    for (const std::size_t spheres : {1, 1000, 100'000, 1'000'000}) {
        scene.spheres.assign(spheres, {.radius = 0.05F});
        const double work = static_cast<double>(scene::maxSubstepsFor(scene)) * static_cast<double>(spheres);
        EXPECT_LE(work, 2e8) << spheres;
        EXPECT_GE(scene::maxSubstepsFor(scene), 64U) << spheres;
    }
}

TEST(SimulationHost, AcceptsPushesOnlyUpToTheStatedLimit) {
    for (const char* model : {"FAST", "BALANCED", "ACCURATE"}) {
        const auto world = open("box-4k");
        load(*world, std::string(R"("quality":{"model":")") + model + "\"}," + thrown);
        const Error refused = refusalOf(*world, R"({"push":{"sphere":0,"impulse":[1e9,0,0]}})");
        const auto at = refused.message.rfind("at most ");
        ASSERT_NE(at, std::string::npos) << refused.text();
        const double most = std::stod(refused.message.substr(at + 8));
        refusalOf(*world, fmt::format(R"({{"push":{{"sphere":0,"impulse":[{},0,0]}}}})", 1.001 * most));
        done(*world, fmt::format(R"({{"push":{{"sphere":0,"impulse":[{},0,0]}}}})", 0.999 * most));
        // After the largest accepted push, the sphere does not move too far in a substep.
        sim::Simulation& simulation = world->simulation();
        const double h = simulation.scene().step / simulation.substeps();
        EXPECT_LE(glm::length(sim::velocityOf(simulation.snapshot(), 0)) * h, 1.001 * scene::safeMotion * 0.05);
    }
}

// A command that is cancelled does not change the speed either.
TEST(SimulationHost, AppliesSpeedTogetherWithTheRestOfItsCommand) {
    const auto world = open("two-spheres");
    const char* set = R"({"set":{"speed":4,"model":"ACCURATE"}})";
    ASSERT_FALSE(give(*world, commandOf(set)));
    world->cancelChange();
    EXPECT_EQ(world->scheduler().speed(), 1);
    ASSERT_FALSE(give(*world, commandOf(set)));
    Result<sim::Applied> result;
    piecesOf(*world, 1'000'000'000, result);
    ASSERT_TRUE(result) << result.error().text();
    EXPECT_EQ(world->scheduler().speed(), 4);
}

// Even for a very fast sphere, the refusal gives an impulse that is accepted.
TEST(SimulationHost, RefusalStatesTheLargestPushForAVeryFastSphere) {
    const auto world = open();
    load(*world, thrown);
    done(*world, R"({"set":{"substeps":20}})");
    done(*world, R"({"push":{"sphere":0,"impulse":[1000,0,0]}})");
    done(*world, R"({"set":{"substeps":1}})");  // too few substeps for this speed: the sphere is now too fast
    const Error refused = refusalOf(*world, R"({"push":{"sphere":0,"impulse":[-1e9,0,0]}})");
    const auto at = refused.message.rfind("at most ");
    ASSERT_NE(at, std::string::npos) << refused.text();
    const double most = std::stod(refused.message.substr(at + 8));
    EXPECT_GT(most, 0) << refused.text();
    done(*world, fmt::format(R"({{"push":{{"sphere":0,"impulse":[{},0,0]}}}})", -0.999 * most));
}

TEST(SimulationHost, RefusesScenesWithTooFastSpheres) {
    const auto world = open();
    const std::string scene = R"("bounds":{"min":[-1,-1,-1],"max":[1,1,1]},"groups":[{"radius":{"constant":0.05},
        "velocity":[0,{},0],"list":{"spheres":[{"position":[0,0,0]}]}}])";
    const auto with = [&](const std::string& speed) {
        std::string text = scene;
        return text.replace(text.find("{},"), 2, speed);
    };
    ASSERT_FALSE(give(*world, commandOf(R"({"load":{"scene":{)" + with("1e8") + "}}}")));
    Result<sim::Applied> result;
    piecesOf(*world, 1'000'000'000, result);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().where, "scene.groups[0]");
    const auto at = result.error().message.rfind("compute is ");
    ASSERT_NE(at, std::string::npos) << result.error().text();
    load(*world, with(fmt::format("{}", 0.999 * std::stod(result.error().message.substr(at + 11)))));
}

}  // namespace
}  // namespace spherule::host
