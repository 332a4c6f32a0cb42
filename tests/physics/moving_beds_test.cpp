// Beds of spheres in obstacles that move: in an accelerated box, in a drum, and around a paddle.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "scene/random.h"
#include "scene/shapes.h"
#include "support.h"

namespace spherule::physics {
namespace {

using measure::addSphere;
using measure::setFriction;
using scene::Model;

constexpr double radius = 0.05;  // m

class MovingBeds : public testing::TestWithParam<Model> {};

// A bed in a box that is suddenly accelerated upwards by 5 g has nearly the same overlaps as one at rest whose weight
// suddenly grows sixfold.
class AcceleratedBox : public testing::TestWithParam<std::uint64_t> {};  // by seed

TEST_P(AcceleratedBox, HoldsABed) {
    double overlaps[2];
    for (const bool accelerated : {false, true}) {
        scene::Scene scene = fineStepSpace(12);
        scene.step = 1.0 / 960;
        scene.quality = {.model = Model::Balanced, .substeps = 1};
        scene.forces.gravity = {0, 0, -earth};
        setRestitution(scene, 0.3);
        setFriction(scene, 0.3);
        scene.obstacles.push_back({.shape = scene::boxShape({{-0.3, -0.3, -3}, {0.3, 0.3, 2}}, true), .colour = ""});
        if (accelerated)
            scene.obstacles[0].motion = scene::Motion{.acceleration = {0, 0, 5 * earth}, .begin = 1, .duration = 0.3};
        scene::Random random(GetParam());
        for (int k = 0; k < 450; ++k) {
            const glm::dvec3 place(k % 5, k / 5 % 5, k / 25);
            const glm::dvec3 jitter(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            addSphere(scene, glm::dvec3(-0.23, -0.23, -2.94) + 0.115 * place + 0.005 * jitter, radius);
        }
        const auto simulation = simulate(scene);
        run(*simulation, 1);
        if (!accelerated) {
            ASSERT_TRUE(simulation->apply(sim::Set{.gravity = glm::dvec3(0, 0, -6 * earth)}));
        }
        run(*simulation, 0.2);
        double sum = 0;
        for (int k = 0; k < 10; ++k) {
            run(*simulation, 0.008);
            sum += simulation->statistics().overlapMean;
        }
        overlaps[accelerated ? 1 : 0] = sum / 10;
    }
    EXPECT_LT(overlaps[1], 1.2 * overlaps[0]);
    EXPECT_GT(overlaps[1], 0.5 * overlaps[0]);
    RecordProperty("ratio", std::to_string(overlaps[1] / overlaps[0]));
}

INSTANTIATE_TEST_SUITE_P(Of, AcceleratedBox, testing::Values(56U, 57U, 58U));

// The torque that keeps a drum turning is the weight of its content times the lever of the centre of mass.
void expectTorqueOfALever(Model model, std::uint64_t seed) {
    const bool soft = model == Model::Accurate;
    constexpr double size = 0.3;  // m, radius of the drum
    constexpr double r = 0.03;    // m
    scene::Scene scene = fineStepSpace(1);
    scene.quality = {.model = model, .substeps = soft ? 10U : 1U};
    scene.forces.gravity = {0, 0, -earth};
    scene.contactSums = true;
    setRestitution(scene, 0.3);
    setFriction(scene, 0.5);
    scene.materials[0].rollingResistance = 0.1;
    scene.obstacles.push_back(obstacleFrom(
        R"({"cylinder":{"from":[0,-0.1,0],"to":[0,0.1,0],"radius":0.3,"hollow":true},"motion":{"spin":[0,1.2,0]}})"));
    scene::Random random(seed);
    for (int k = 0; k < 126; ++k) {
        const glm::dvec3 place(k % 6 - 2.5, k / 6 % 3 - 1, k / 18 - 3);
        const glm::dvec3 jitter(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        addSphere(scene, glm::dvec3(0.063 * place.x, 0.064 * place.y, 0.063 * place.z) + 0.001 * jitter, r);
    }
    ASSERT_LT(glm::length(glm::dvec3(0.063 * 2.5, 0, 0.063 * 3)) + r, size);
    const auto simulation = simulate(scene);
    run(*simulation, 3);
    const sim::ContactSums before = *simulation->statistics().contactSums;
    const double seconds = soft ? 3 : 8;
    double lever = 0;  // mean of the moment of the weight, N m
    int times = 0;
    for (const double end = simulation->time() + seconds; simulation->time() < end; ++times) {
        run(*simulation, 0.02);
        const sim::State state = simulation->snapshot();
        for (std::uint32_t id = 0; id < state.count(); ++id)
            lever +=
                earth / static_cast<double>(std::abs(state.velocity[id].w)) * static_cast<double>(state.position[id].x);
    }
    lever /= times;
    sim::Statistics now = simulation->statistics();
    sim::setMeans(now, now.contactSums->since(before), simulation->scene());
    double torque = 0;
    for (const sim::SurfaceForce& on : now.surfaceForces) torque += on.torque.y;
    EXPECT_GT(std::abs(lever), 0.2);
    EXPECT_GT(now.speedRms, 0.1);  // the bed turns with the drum
    EXPECT_NEAR(torque, lever, 0.01 * std::abs(lever));
    testing::Test::RecordProperty("error " + std::to_string(seed), std::to_string(torque / lever - 1));
}

TEST_P(MovingBeds, TorqueOfADrumIsTheLeverOfItsContent) {
    for (const std::uint64_t seed : {57U, 58U, 59U}) expectTorqueOfALever(GetParam(), seed);
}

// A paddle that moves over sleeping spheres wakes only those that it comes near. While it rests, none wakes.
TEST(MovingBed, PaddleWakesTheSpheresInItsReach) {
    scene::Scene scene = sleepyBox(2);
    setFriction(scene, 0.5);
    scene.materials[0].rollingResistance = 0.1;
    for (int k = 0; k < 100; ++k)
        addSphere(scene, {-0.8 + 0.17 * (k % 10), -0.8 + 0.17 * (k / 10), -1 + radius}, radius);
    scene::Motion motion{.velocity = {0.2, 0, 0}, .begin = 3, .duration = 1};
    scene.obstacles.push_back(
        {.shape = scene::boxShape({{-0.99, -0.99, -0.95}, {-0.86, -0.05, -0.8}}), .colour = "", .motion = motion});
    const auto simulation = simulate(scene);
    run(*simulation, 2.9);
    EXPECT_EQ(sleepers(simulation->snapshot()), 100U);
    run(*simulation, 0.6);
    // It has come to x = -0.76: it has met the first column, in its own half.
    sim::State state = simulation->snapshot();
    int awake = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        if (asleep(state, id)) continue;
        ++awake;
        EXPECT_LT(state.position[id].x, -0.55F) << id;
        EXPECT_LT(state.position[id].y, 0.1F) << id;
    }
    EXPECT_GE(awake, 4);
    run(*simulation, 5);
    EXPECT_EQ(sleepers(simulation->snapshot()), 100U);
}

INSTANTIATE_TEST_SUITE_P(Of, MovingBeds, testing::Values(Model::Fast, Model::Balanced, Model::Accurate),
                         [](const auto& test) { return std::string(scene::nameOf(test.param)); });

}  // namespace
}  // namespace spherule::physics
