// Fixed spheres: infinite mass.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "mixed.h"
#include "scene/quality.h"
#include "scene/random.h"
#include "scene/stiffness.h"
#include "support.h"

namespace spherule::physics {
namespace {

using measure::addSphere;
using measure::setFriction;

scene::Sphere& addFixed(scene::Scene& scene, glm::dvec3 position, double radius, std::uint8_t material = 0) {
    scene::Sphere& sphere = addSphere(scene, position, radius, {}, material);
    sphere.fixed = true;
    return sphere;
}

void choose(scene::Scene& scene, scene::Model model) {
    scene.quality.model = model;
    scene.quality.substepsFixed = false;
    ASSERT_TRUE(scene::fitSubsteps(scene));
}

class Fixed : public testing::TestWithParam<scene::Model> {};
class SleepOnFixed : public Fixed {};  // of the models in which spheres sleep

// Every third sphere of a heap in a box is fixed. Some of these overlap.
scene::Scene heapWithFixed(scene::Model model, std::uint64_t seed) {
    scene::Scene scene = sleepyBox(1);
    setFriction(scene, 0.4);
    scene::Random random(seed);
    for (int k = 0; k < 216; ++k) {
        const glm::dvec3 place = 0.15 * (glm::dvec3(k % 6, k / 6 % 6, k / 36) - 2.5);
        scene::Sphere& sphere = addSphere(scene, place, random.uniform(0.03, 0.06));
        sphere.fixed = k % 3 == 0;
        if (!sphere.fixed)
            sphere.velocity = {static_cast<float>(random.normal()), 0, static_cast<float>(random.normal())};
    }
    for (int k = 0; k < 3; ++k) addFixed(scene, {0.02 * k, 0, 0.44}, 0.05);
    choose(scene, model);
    return scene;
}

TEST_P(Fixed, SpheresStayWhereTheyAre) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        scene::Scene scene = heapWithFixed(GetParam(), seed);
        scene.forces.fields = {scene::Drag{}, scene::Attraction{{0.2, 0.1, -0.3}, 0.5, 0.1}};
        choose(scene, GetParam());
        auto simulation = simulate(scene);
        const sim::State before = simulation->snapshot();
        run(*simulation, GetParam() == scene::Model::Accurate ? 0.1 : 1);
        const sim::State after = simulation->snapshot();
        double moved = 0;
        for (std::uint32_t id = 0; id < after.count(); ++id) {
            EXPECT_EQ(after.velocity[id].w == 0, scene.spheres[id].fixed);
            moved += glm::length(positionOf(after, id) - positionOf(before, id));
            if (!scene.spheres[id].fixed) continue;
            EXPECT_EQ(after.position[id], before.position[id]);
            EXPECT_EQ(glm::vec3(after.velocity[id]), glm::vec3(0));
            EXPECT_EQ(after.spin[id], glm::vec4(0));
        }
        EXPECT_GT(moved, 1) << "the others fall";
        EXPECT_TRUE(allFinite(after));
    }
}

TEST_P(Fixed, SpheresTakeNoPartInStatistics) {
    auto simulation = simulate(heapWithFixed(GetParam(), 4));
    run(*simulation, 0.1);
    const sim::State state = simulation->snapshot();
    const sim::Statistics statistics = simulation->statistics();
    double kinetic = 0;
    double squares = 0;
    double height = 0;
    std::uint32_t movable = 0;
    glm::dvec3 momentum{};
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        if (simulation->scene().spheres[id].fixed) continue;
        const double mass = massOf(state, id);
        const glm::dvec3 v = velocityOf(state, id);
        kinetic += mass * glm::dot(v, v) / 2;
        squares += glm::dot(v, v);
        momentum += mass * v;
        height += positionOf(state, id).z + 0.5;
        ++movable;
    }
    EXPECT_NEAR(statistics.kineticEnergy, kinetic, 1e-5 * kinetic);
    EXPECT_NEAR(statistics.speedRms, std::sqrt(squares / movable), 1e-5 * statistics.speedRms);
    EXPECT_NEAR(statistics.meanHeight, height / movable, 1e-5);
    EXPECT_LT(glm::length(statistics.momentum - momentum), 1e-5 * momentumScale(state));
    EXPECT_EQ(statistics.nonFinite, 0U);
    EXPECT_TRUE(std::isfinite(statistics.potentialEnergy + statistics.rotationalEnergy + statistics.elasticEnergy));
    EXPECT_TRUE(std::isfinite(kineticEnergyOf(state) + glm::length(momentumOf(state))));
}

TEST_P(Fixed, SpheresDoNotMeetEachOther) {
    scene::Scene scene = fineStepSpace(4);
    for (int k = 0; k < 20; ++k) addFixed(scene, {0.01 * k, 0, 0}, 0.1);
    addSphere(scene, {0, 1, 0}, 0.1);
    choose(scene, GetParam());
    auto simulation = simulate(scene);
    run(*simulation, 0.05);
    const sim::Statistics statistics = simulation->statistics();
    EXPECT_EQ(statistics.contacts, 0U);
    EXPECT_EQ(statistics.overlapMax, 0);
    EXPECT_EQ(simulation->counters().pairs, simulation->counters().pairs / PAIR_PADDING * PAIR_PADDING)
        << "no pair is listed";
    EXPECT_EQ(simulation->contactCounts(), std::vector<std::uint32_t>(21, 0U));
}

// A sphere leaves a fixed one as two-body mechanics says for an infinite mass: e along the normal, and friction that
// either stops the slip or reaches its limit.
TEST_P(Fixed, SphereThrowsAnotherBackByItsMaterial) {
    constexpr double r = 0.05;
    const bool accurate = GetParam() == scene::Model::Accurate;
    for (const double restitution : {0.0, 0.5, 1.0})
        for (const double friction : {0.0, 0.1, 0.8}) {
            if (accurate && friction > 0) continue;  // the springs of a soft contact throw the slip back
            scene::Scene scene = fineStepSpace(4);
            scene.quality.overlap = 0.02;
            setRestitution(scene, restitution);
            setFriction(scene, friction);
            addFixed(scene, {0, 0, 0}, r);
            const double offset = r;  // the normal is at 30 degrees to the path
            addSphere(scene, {-0.11, offset, 0}, r, {2, 0, 0});
            choose(scene, GetParam());
            auto simulation = simulate(scene);
            run(*simulation, 0.1);
            const glm::dvec3 n(-std::sqrt(3.0) / 2, 0.5, 0);
            const glm::dvec3 tangent(0.5, std::sqrt(3.0) / 2, 0);
            const double normalSpeed = -2 * n.x;  // towards the fixed sphere
            const double slip = 2 * tangent.x;
            const double stopped = std::min(2.0 / 7 * slip, friction * (1 + restitution) * normalSpeed);
            const glm::dvec3 expected = n * (restitution * normalSpeed) + tangent * (slip - stopped);
            // Soft spheres turn the normal during the contact.
            const double tolerance = accurate ? 0.03 : 2e-3;
            EXPECT_LT(glm::length(velocityOf(simulation->snapshot(), 1) - expected), tolerance)
                << "restitution " << restitution << ", friction " << friction;
        }
}

// A fixed sphere acts as one that is a million times as heavy, with rolling and all.
TEST_P(Fixed, SphereActsAsAVeryHeavyOne) {
    scene::Scene scene = fineStepSpace(4);
    scene.materials = {{.name = "a", .restitution = 0.6, .friction = 0.4, .rollingResistance = 0.1}};
    addFixed(scene, {0, 0, 0}, 0.07);
    addSphere(scene, {-0.13, 0.05, 0.02}, 0.05, {2, 0, 0}).spin = {3, 40, -20};
    choose(scene, GetParam());
    scene.quality.substepsFixed = true;
    scene::Scene heavy = scene;
    heavy.spheres[0].fixed = false;
    heavy.spheres[0].material = addMaterial(
        heavy, {.name = "b", .density = 1e9, .restitution = 0.6, .friction = 0.4, .rollingResistance = 0.1});
    const auto stateAfter = [](const scene::Scene& one) {
        auto simulation = simulate(one);
        run(*simulation, 0.1);
        return simulation->snapshot();
    };
    const sim::State fixed = stateAfter(scene);
    const sim::State reference = stateAfter(heavy);
    EXPECT_GT(glm::length(velocityOf(reference, 1) - glm::dvec3(2, 0, 0)), 0.5) << "they meet";
    EXPECT_LT(glm::length(velocityOf(fixed, 1) - velocityOf(reference, 1)), 1e-4);
    EXPECT_LT(glm::length(spinOf(fixed, 1) - spinOf(reference, 1)), 3e-3);
    EXPECT_LT(glm::length(positionOf(fixed, 1) - positionOf(reference, 1)), 1e-5);
}

// Spheres that move together need no new lists, except when something stands in their way.
TEST_P(Fixed, SphereIsMetByACloudThatMovesAsAWhole) {
    scene::Scene scene = fineStepSpace(20);
    setRestitution(scene, 1);
    addFixed(scene, {0, 0, 0}, 0.05);
    for (int k = 0; k < 27; ++k)
        addSphere(scene, {-0.6 + 0.25 * (k % 3), 0.25 * (k / 3 % 3 - 1), 0.25 * (k / 9 - 1)}, 0.05, {2, 0, 0});
    choose(scene, GetParam());
    auto simulation = simulate(scene);
    run(*simulation, 0.5);
    const sim::State state = simulation->snapshot();
    EXPECT_LT(velocityOf(state, 15).x, -1.9) << "the first of the row that hits it head-on";
    EXPECT_NEAR(velocityOf(state, 1).x, 2, 1e-5) << "a row that passes";
}

TEST_P(SleepOnFixed, SpheresCarryASleeper) {
    scene::Scene scene = sleepyBox(2);
    setFriction(scene, 0.5);
    const double r = 0.1;
    for (int k = 0; k < 3; ++k) {
        const double angle = 2 * 3.14159265358979 / 3 * k;
        addFixed(scene, {0.11 * std::cos(angle), 0.11 * std::sin(angle), 0}, r);
    }
    // A millimetre above its place: from higher up, it leaves over two of the three.
    addSphere(scene, {0, 0, 0.168}, r);
    choose(scene, GetParam());
    auto simulation = simulate(scene);
    run(*simulation, 3);
    sim::State state = simulation->snapshot();
    EXPECT_TRUE(asleep(state, 3));
    EXPECT_NEAR(positionOf(state, 3).z, std::sqrt(4 * r * r - 0.11 * 0.11), 2e-3);
    // In `fast`, the last push of a substep may leave gaps.
    const std::uint32_t least = GetParam() == scene::Model::Balanced ? 3 : 1;
    EXPECT_GE(simulation->contactCounts()[3], least);
    EXPECT_EQ(simulation->statistics().sleeping, 1U) << "a fixed sphere does not sleep";
    run(*simulation, 2);
    EXPECT_TRUE(asleep(simulation->snapshot(), 3)) << "nothing wakes it";
    ASSERT_TRUE(simulation->apply(sim::Set{.gravity = glm::dvec3(5, 0, 0)}));
    run(*simulation, 1);
    EXPECT_GT(positionOf(simulation->snapshot(), 3).x, 0.5) << "it falls off";
}

TEST_P(Fixed, SphereRefusesPushes) {
    scene::Scene scene = fineStepSpace(2);
    addFixed(scene, {0, 0, 0}, 0.1);
    addSphere(scene, {0.5, 0, 0}, 0.1);
    choose(scene, GetParam());
    auto simulation = simulate(scene);
    for (const sim::Push& push : {sim::Push{.target = 0U, .impulse = {1, 0, 0}},
                                  sim::Push{.target = sim::Ray{{0, 0, 1}, {0, 0, -1}}, .impulse = {1, 0, 0}}}) {
        const auto refused = simulation->apply(push);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().text(), "sphere 0 is fixed: nothing moves it");
    }
    EXPECT_TRUE(simulation->apply(sim::Push{.target = 1U, .impulse = {0.01, 0, 0}}));
}

INSTANTIATE_TEST_SUITE_P(Of, SleepOnFixed, testing::Values(scene::Model::Fast, scene::Model::Balanced),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

INSTANTIATE_TEST_SUITE_P(Of, Fixed, testing::Values(scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

// Springs and substeps are for the spheres that move, which fall onto the fixed ones as onto a floor.
TEST(FixedSprings, BearAFallOntoFixedSpheres) {
    scene::Scene scene = fineStepSpace(4);
    scene.forces.gravity = {0, 0, -earth};
    const std::uint8_t light = addMaterial(scene, {.name = "light", .density = 1});
    for (int k = 0; k < 25; ++k) addFixed(scene, {0.1 * (k % 5) - 0.2, 0.1 * (k / 5) - 0.2, -1.5}, 0.05, light);
    addSphere(scene, {0, 0, 0}, 0.05);
    scene::Scene heavy = scene;
    for (scene::Sphere& sphere : heavy.spheres) sphere.material = 0;
    choose(scene, scene::Model::Accurate);
    choose(heavy, scene::Model::Accurate);
    EXPECT_EQ(scene.quality.substeps, heavy.quality.substeps) << "the mass of a fixed sphere does not count";
    auto simulation = simulate(scene);
    double deepest = 0;
    for (int k = 0; k < 600; ++k) {
        run(*simulation, simulation->scene().step);
        if (k > 200 && k % 2 == 0) deepest = std::max(deepest, simulation->statistics().overlapMax);
    }
    EXPECT_GT(deepest, 0.2 * scene.quality.overlap);
    EXPECT_LT(deepest, 1.5 * scene.quality.overlap);
    EXPECT_GT(positionOf(simulation->snapshot(), 25).z, -1.5) << "it has not fallen through";
}

}  // namespace
}  // namespace spherule::physics
