// Obstacles that are added, moved and removed while the simulation runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "scene/shapes.h"
#include "support.h"

namespace spherule::physics {
namespace {

using measure::addSphere;
using measure::setFriction;
using scene::Model;

constexpr double radius = 0.05;  // m

sim::ChangeObstacle add(const std::string& json) {
    return {.make = [json](const scene::Scene& scene) -> Result<std::optional<scene::Obstacle>> {
        scene::Obstacle obstacle = obstacleFrom(json);
        if (obstacle.motion) obstacle.motion->begin += scene.time;
        return obstacle;
    }};
}

sim::ChangeObstacle replace(std::uint32_t number, const std::string& json) {
    sim::ChangeObstacle change = add(json);
    change.obstacle = number;
    return change;
}

sim::ChangeObstacle removed(std::uint32_t number) {
    return {.obstacle = number,
            .make = [](const scene::Scene&) -> Result<std::optional<scene::Obstacle>> { return std::nullopt; }};
}

std::set<std::uint32_t> awake(sim::Simulation& simulation) {
    const sim::State state = simulation.snapshot();
    std::set<std::uint32_t> ids;
    for (std::uint32_t id = 0; id < state.count(); ++id)
        if (!asleep(state, id)) ids.insert(id);
    return ids;
}

// 100 spheres far from each other that sleep on the floor of a box: number k lies at column k % 10, row k / 10.
std::unique_ptr<sim::Simulation> sleepingField(Model model) {
    scene::Scene scene = sleepyBox(2);
    scene.quality.model = model;
    setFriction(scene, 0.5);
    scene.materials[0].rollingResistance = 0.1;
    for (int k = 0; k < 100; ++k)
        addSphere(scene, {-0.8 + 0.17 * (k % 10), -0.8 + 0.17 * (k / 10), -1 + radius}, radius);
    auto simulation = simulate(scene);
    run(*simulation, 3);
    EXPECT_EQ(sleepers(simulation->snapshot()), 100U);
    return simulation;
}

class ObstacleCommands : public testing::TestWithParam<Model> {};

TEST_P(ObstacleCommands, WakeOnlyTheSpheresInReach) {
    if (GetParam() == Model::Accurate) return;  // nothing sleeps
    const auto simulation = sleepingField(GetParam());
    // A box on the first sphere, which touches it.
    ASSERT_TRUE(simulation->apply(add(R"({"box":{"min":[-0.85,-0.85,-0.9],"max":[-0.75,-0.75,-0.5]}})")));
    EXPECT_EQ(awake(*simulation), (std::set<std::uint32_t>{0}));
    run(*simulation, 3);
    EXPECT_TRUE(awake(*simulation).empty());
    // It moves to the sphere in the middle.
    ASSERT_TRUE(simulation->apply(replace(0, R"({"box":{"min":[0.0,0.0,-0.9],"max":[0.1,0.1,-0.5]}})")));
    EXPECT_EQ(awake(*simulation), (std::set<std::uint32_t>{0, 55}));
    run(*simulation, 3);
    ASSERT_TRUE(simulation->apply(removed(0)));
    EXPECT_EQ(awake(*simulation), (std::set<std::uint32_t>{55}));
    run(*simulation, 3);
    EXPECT_TRUE(awake(*simulation).empty());
    EXPECT_TRUE(simulation->scene().obstacles.empty());
}

// A pile at rest, with sleep off, does not notice an obstacle that comes and goes elsewhere: its contacts keep what
// they hold.
TEST_P(ObstacleCommands, LeaveAPileAlone) {
    scene::Scene scene = fineStepBox(0.4);
    scene.quality = {.model = GetParam(), .substeps = GetParam() == Model::Accurate ? 100U : 1U};
    setRestitution(scene, 0.3);
    setFriction(scene, 0.4);
    scene.bounds.max.z = 1;
    for (int k = 0; k < 36; ++k)
        addSphere(scene, {-0.11 + 0.11 * (k % 3), -0.11 + 0.11 * (k / 3 % 3), -0.14 + 0.105 * (k / 9)}, radius);
    const auto simulation = simulate(scene);
    run(*simulation, GetParam() == Model::Accurate ? 1 : 4);
    const double before = simulation->statistics().speedRms;
    const sim::State start = simulation->snapshot();
    ASSERT_TRUE(simulation->apply(add(R"({"sphere":{"centre":[0,0,0.8],"radius":0.1},"motion":{"spin":[0,0,9]}})")));
    double fastest = 0;
    for (int k = 0; k < 20; ++k) {
        run(*simulation, 1.0 / 480);
        fastest = std::max(fastest, simulation->statistics().speedRms);
    }
    ASSERT_TRUE(simulation->apply(removed(0)));
    for (int k = 0; k < 20; ++k) {
        run(*simulation, 1.0 / 480);
        fastest = std::max(fastest, simulation->statistics().speedRms);
    }
    // Without the held impulses, every sphere would fall for a substep.
    EXPECT_LT(fastest, std::max(2 * before, 0.1 * 9.81 / 480));
    const sim::State end = simulation->snapshot();
    for (std::uint32_t id = 0; id < end.count(); ++id)
        EXPECT_LT(glm::distance(glm::vec3(end.position[id]), glm::vec3(start.position[id])), 2e-3F * 0.05F) << id;
}

// A sphere on a slope is held by friction. The obstacle before the slope is removed, so that the slope gets its number.
TEST_P(ObstacleCommands, KeepWhatOtherObstaclesHold) {
    if (GetParam() == Model::Fast) return;  // its contacts hold nothing
    const double angle = 0.3;
    const glm::dvec3 up(std::sin(angle), 0, std::cos(angle));
    scene::Scene scene = fineStepSpace(4);
    scene.quality = {.model = GetParam(), .substeps = GetParam() == Model::Accurate ? 100U : 1U};
    scene.forces.gravity = {0, 0, -9.81};
    setRestitution(scene, 0);
    setFriction(scene, 0.6);
    scene.materials[0].rollingResistance = 0.5;
    scene.obstacles.push_back(obstacleFrom(R"({"sphere":{"centre":[1,1,1],"radius":0.1}})"));
    scene.obstacles.push_back({.shape = scene::planeShape({0, 0, 0}, up), .colour = ""});
    addSphere(scene, radius * up, radius);
    const auto simulation = simulate(scene);
    const auto place = [&] { return glm::vec3(simulation->snapshot().position[0]); };
    run(*simulation, 0.5);
    const glm::vec3 first = place();
    run(*simulation, 0.5);
    const glm::vec3 before = place();
    const auto done = simulation->apply(removed(0));
    ASSERT_TRUE(done) << done.error().text();
    run(*simulation, 0.5);
    // Soft contacts creep a little.
    EXPECT_LT(glm::distance(place(), before), 1.2F * glm::distance(before, first) + 1e-4F * 0.05F);
    EXPECT_LT(glm::distance(place(), before), 3e-3F * 0.05F);
    EXPECT_EQ(simulation->scene().obstacles.size(), 1U);
}

TEST_P(ObstacleCommands, TakeTheFloorAway) {
    scene::Scene scene = fineStepSpace(4);
    scene.quality = {.model = GetParam(), .substeps = GetParam() == Model::Accurate ? 50U : 1U};
    scene.forces.gravity = {0, 0, -9.81};
    setRestitution(scene, 0);
    scene.obstacles.push_back(obstacleFrom(R"({"box":{"min":[-1,-1,-1],"max":[1,1,0]}})"));
    addSphere(scene, {0, 0, radius}, radius);
    const auto simulation = simulate(scene);
    run(*simulation, 0.5);
    const auto done = simulation->apply(removed(0));
    ASSERT_TRUE(done);
    EXPECT_EQ(done->obstacle, 0U);
    const double begin = simulation->time();
    run(*simulation, 0.25);
    const double time = simulation->time() - begin;
    EXPECT_NEAR(simulation->snapshot().position[0].z, radius - 0.5 * 9.81 * time * time, 2e-3);
}

// A lid that begins to move when it is added pushes a sphere along.
TEST_P(ObstacleCommands, BeginAMotionNow) {
    scene::Scene scene = fineStepSpace(4);
    scene.quality = {.model = GetParam(), .substeps = GetParam() == Model::Accurate ? 50U : 1U};
    setRestitution(scene, 0);
    addSphere(scene, {0.5, 0, 0}, radius);
    const auto simulation = simulate(scene);
    run(*simulation, 0.3);
    const auto done = simulation->apply(
        add(R"({"box":{"min":[-0.5,-0.5,-0.5],"max":[0,0.5,0.5]},"motion":{"velocity":[1,0,0],"duration":1}})"));
    ASSERT_TRUE(done) << done.error().text();
    EXPECT_EQ(done->obstacle, 0U);
    run(*simulation, 0.9);
    EXPECT_NEAR(simulation->snapshot().position[0].x, 0.9 + radius, 5e-3);
    EXPECT_NEAR(simulation->snapshot().velocity[0].x, 1, 3e-3);
}

TEST_P(ObstacleCommands, RefuseWhatCannotBe) {
    scene::Scene scene = fineStepSpace(4);
    scene.quality = {.model = GetParam(), .substeps = 50};
    addSphere(scene, {0.5, 0, 0}, radius, {1, 0, 0});
    const auto simulation = simulate(scene);
    EXPECT_EQ(simulation->apply(removed(0)).error().text(), "obstacle: is not there: the scene has no obstacles");
    EXPECT_EQ(simulation->apply(add(R"({"sphere":{"centre":[0.5,0,0.1],"radius":0.1}})")).error().text(),
              "obstacle: would be where sphere 0 is; remove the sphere, or choose another place");
    EXPECT_NE(simulation->apply(add(R"({"sphere":{"centre":[1,0,1],"radius":0.1},"motion":{"velocity":[1e8,0,0]}})"))
                  .error()
                  .text()
                  .find("obstacles[0].motion: moves its surface at up to 1e+08 m/s"),
              std::string::npos);
    ASSERT_TRUE(simulation->apply(add(R"({"sphere":{"centre":[1,0,1],"radius":0.1}})")));
    EXPECT_EQ(simulation->apply(removed(1)).error().text(), "obstacle: is 1, must be 0 to 0");
    EXPECT_EQ(simulation->scene().obstacles.size(), 1U);
}

INSTANTIATE_TEST_SUITE_P(Of, ObstacleCommands, testing::Values(Model::Fast, Model::Balanced, Model::Accurate),
                         [](const auto& test) { return std::string(scene::nameOf(test.param)); });

}  // namespace
}  // namespace spherule::physics
