// Drag and attraction, in each model, against exact solutions and against an integration in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "diagnostics/energy_watch.h"
#include "field_support.h"
#include "scene/quality.h"

namespace spherule::physics {
namespace {

constexpr double pi = std::numbers::pi;

class Fields : public testing::TestWithParam<scene::Model> {};

// v = v_t tanh(g t / v_t), with v_t = 48.158 m/s.
TEST_P(Fields, DragLimitsTheSpeedOfAFall) {
    constexpr double terminal = 48.158;
    scene::Scene scene = oneSphere(GetParam(), {}, {});
    scene.forces = {.gravity = {0, 0, -earth}, .fields = {scene::Drag{}}};
    const auto simulation = simulate(scene);
    for (int second = 1; second <= 25; ++second) {
        run(*simulation, 1);
        const double expected = terminal * std::tanh(earth * second / terminal);
        EXPECT_NEAR(-velocityOf(simulation->snapshot(), 0).z, expected, 1e-3 * expected) << second << " s";
    }
    EXPECT_NEAR(-velocityOf(simulation->snapshot(), 0).z, terminal, 1e-3 * terminal);
}

// A medium a hundred times as dense as the sphere stops it, and never turns it back.
TEST_P(Fields, StrongDragReversesNoMotion) {
    scene::Scene scene = oneSphere(GetParam(), {}, {3, -4, 0});
    scene.forces.fields = {scene::Drag{.density = 1e5, .coefficient = 1e3}};
    const auto simulation = simulate(scene);
    double before = 5;
    for (int step = 0; step < 100; ++step) {
        run(*simulation, scene.step);
        const glm::dvec3 v = velocityOf(simulation->snapshot(), 0);
        EXPECT_GT(v.x, 0);
        EXPECT_NEAR(0.8 * v.x + 0.6 * v.y, 0, 2e-6) << "to the side";
        EXPECT_LT(glm::length(v), before);
        before = glm::length(v);
    }
    EXPECT_LT(before, 0.01);
}

// Ten turns around a centre, in random planes and directions. The period is 2 pi sqrt(R^3 / strength).
TEST_P(Fields, CircularOrbitsKeepPeriodAndRadius) {
    scene::Random random(3);
    for (int seed = 0; seed < 4; ++seed) {
        const double distance = random.uniform(0.5, 2);
        const glm::dvec3 centre = random.uniform(0, 3) * randomDirection(random);
        const glm::dvec3 out = randomDirection(random);
        const glm::dvec3 along = glm::normalize(glm::cross(out, randomDirection(random)));
        const double period = random.uniform(3, 6);  // s
        const double strength = std::pow(2 * pi / period, 2) * std::pow(distance, 3);
        scene::Scene scene = oneSphere(GetParam(), centre + distance * out, 2 * pi * distance / period * along);
        scene.forces.fields = {scene::Attraction{centre, strength, 1e-3}};
        const auto simulation = simulate(scene);
        const glm::dvec3 middle = centre - scene.bounds.centre();
        double drift = 0;
        double angle = 0;
        glm::dvec3 last = out;
        const long steps = std::lround(10 * period / scene.step);
        for (long k = 0; k < steps; ++k) {
            run(*simulation, scene.step);
            const glm::dvec3 d = positionOf(simulation->snapshot(), 0) - middle;
            drift = std::max(drift, std::abs(glm::length(d) / distance - 1));
            const glm::dvec3 now = glm::normalize(d);
            angle += std::asin(glm::length(glm::cross(last, now)));
            last = now;
        }
        EXPECT_LT(drift, 1e-3);
        const double turns = static_cast<double>(steps) * scene.step / period;
        EXPECT_NEAR(angle / (2 * pi) / turns, 1, 1e-3);
    }
}

// Throws spheres through gravity, drag, an attraction and a repulsion.
TEST_P(Fields, FlightsFollowTheReference) {
    scene::Random random(8);
    for (int seed = 0; seed < 8; ++seed) {
        const Motion start{2.0 * randomDirection(random), 3.0 * randomDirection(random)};
        scene::Scene scene = oneSphere(GetParam(), start.x, start.v);
        scene.forces.gravity = 3.0 * randomDirection(random);
        scene.forces.fields = {scene::Drag{.density = 50},
                               scene::Attraction{2.0 * randomDirection(random), random.uniform(1, 4), 0.5},
                               scene::Attraction{4.0 * randomDirection(random), -random.uniform(1, 4), 0.3}};
        const auto simulation = simulate(scene);
        run(*simulation, 2);
        const Motion expected = integrated(scene.forces, start, 2);
        const sim::State state = simulation->snapshot();
        // An error of h / 2 in a change of velocity: drag uses the speed at the beginning of a substep.
        EXPECT_LT(glm::distance(positionOf(state, 0) + scene.bounds.centre(), expected.x), 5e-3);
        EXPECT_LT(glm::distance(velocityOf(state, 0), expected.v), 5e-3);
    }
}

// Kinetic plus potential energy of a sphere that bounces without loss in a box, under gravity and an attraction.
TEST_P(Fields, EnergyOfAnElasticBounceStays) {
    scene::Scene scene = fineStepBox(1);
    scene.quality = {.model = GetParam(), .substeps = GetParam() == scene::Model::Accurate ? 20U : 1U};
    setRestitution(scene, 1);
    scene.spheres = {{.position = {0.1, 0.2, 0.3}, .velocity = {1, -0.5F, 0}, .radius = 0.05F}};
    scene.forces.fields = {scene::Attraction{{0.1, -0.05, 0}, 2, 0.2}};
    const auto simulation = simulate(scene);
    const auto energy = [&] {
        const sim::Statistics now = simulation->statistics();
        return now.kineticEnergy + now.potentialEnergy + now.elasticEnergy - now.pushWork;
    };
    const double before = energy();
    const double scale = 0.5 * simulation->statistics().kineticEnergy + 2 / 0.2 * massOf(simulation->snapshot(), 0);
    for (int k = 0; k < 40; ++k) {
        run(*simulation, 0.1);
        EXPECT_NEAR(energy(), before, 0.01 * scale) << k;
    }
}

// Without gravity, many spheres are pushed against the walls. Commands switch gravity on and off.
TEST_P(Fields, ScenesWithoutGravityTakeCommands) {
    scene::Scene scene = fineStepBox(1);
    scene.forces = {.fields = {scene::Drag{.density = 10}, scene::Attraction{{0, 0, -3}, 100, 0.2}}};
    for (int k = 0; k < 216; ++k) {
        scene::Sphere sphere;
        sphere.radius = static_cast<float>(fieldRadius);
        sphere.position = 0.15 * (glm::dvec3(k % 6, k / 6 % 6, k / 36) - 2.5);
        scene.spheres.push_back(sphere);
    }
    scene.quality = {.model = GetParam(), .substepsFixed = false};
    scene.quality.substeps = static_cast<std::uint32_t>(scene::defaultSubsteps(scene));
    const auto simulation = simulate(scene);
    run(*simulation, 0.5);
    const double low = simulation->statistics().meanHeight;
    EXPECT_LT(low, 0.4) << "the centre is below the floor";
    EXPECT_EQ(simulation->statistics().pushWork != 0, GetParam() == scene::Model::Fast);
    for (const glm::dvec3 gravity : {glm::dvec3(0, 0, 40), glm::dvec3(0)}) {
        ASSERT_TRUE(simulation->apply(sim::Set{.gravity = gravity}));
        run(*simulation, 0.7);
        EXPECT_TRUE(allFinite(simulation->snapshot()));
        EXPECT_EQ(simulation->statistics().outside, 0U);
        if (gravity.z > 0)
            EXPECT_GT(simulation->statistics().meanHeight, 0.6) << "gravity is stronger";
        else
            EXPECT_LT(simulation->statistics().meanHeight, 0.4);
    }
}

// At its terminal speed a grain is slower than the sleep speed. It must not fall asleep in mid-flight.
// (In `accurate` no sphere sleeps.)
TEST(FieldsInHeaps, DragCarriesNoSleeper) {
    for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced}) {
        scene::Scene scene = sleepyBox(1);
        scene.quality.model = model;
        scene.materials[0].friction = 0.3;
        scene.spheres = {{.position = {0, 0, 0.3}, .radius = 0.001F}};
        scene.forces.fields = {scene::Drag{.density = 1000, .coefficient = 400}};
        const auto simulation = simulate(scene);
        run(*simulation, 4);
        const sim::State state = simulation->snapshot();
        EXPECT_FALSE(asleep(state, 0)) << scene::nameOf(model);
        EXPECT_NEAR(-velocityOf(state, 0).z, std::sqrt(earth * 1000 * 4.0 / 3 * 0.001 / (0.5 * 1000 * 400)), 1e-4);
    }
}

// Two spheres that fall from rest to a centre between them, with the stiffness that `accurate` chooses.
TEST(FieldsInHeaps, StiffnessBearsTheMeetingAtACentre) {
    scene::Scene scene = fineStepSpace(4);
    scene.quality = {.model = scene::Model::Accurate, .substepsFixed = false, .overlap = 0.1};
    scene.spheres = {{.position = {-1, 0, 0}, .radius = 0.05F}, {.position = {1, 0, 0}, .radius = 0.05F}};
    scene.forces.fields = {scene::Attraction{{}, 4, 0.05}};
    scene.quality.substeps = static_cast<std::uint32_t>(scene::defaultSubsteps(scene));
    const auto simulation = simulate(scene);
    double deepest = 0;
    for (int step = 0; step < 480; ++step) {
        run(*simulation, scene.step);
        deepest = std::max(deepest, simulation->statistics().overlapMax);
        const sim::State state = simulation->snapshot();
        ASSERT_LT(positionOf(state, 0).x, positionOf(state, 1).x) << "the spheres have passed each other";
    }
    EXPECT_LT(deepest, 0.15);
}

INSTANTIATE_TEST_SUITE_P(Of, Fields, testing::ValuesIn(fieldModels),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

// 343 spheres fall to a centre and come to rest around it. No gain of energy is reported, and a dense ball remains. The
// ball as a whole may go on swinging about the centre.
class AttractedHeap : public testing::TestWithParam<std::uint64_t> {};

TEST_P(AttractedHeap, ComesToRestInABall) {
    scene::Scene scene = fineStepSpace(4);
    scene.materials[0].friction = 0.4;
    setRestitution(scene, 0.3);
    scene.quality.substeps = 1;
    scene.forces.fields = {scene::Drag{.density = 1000}, scene::Attraction{{}, 4, 0.5}};
    scene::Random random(GetParam());
    for (int k = 0; k < 343; ++k) {
        scene::Sphere sphere;
        sphere.radius = static_cast<float>(fieldRadius);
        sphere.position = 0.125 * (glm::dvec3(k % 7, k / 7 % 7, k / 49) - 3.0) + 0.01 * randomDirection(random);
        scene.spheres.push_back(sphere);
    }
    const auto simulation = simulate(scene);
    diagnostics::EnergyWatch watch;
    for (int k = 0; k < 100; ++k) {
        run(*simulation, 0.1);
        const sim::Statistics now = simulation->statistics();
        EXPECT_EQ(watch.check({.step = simulation->steps(),
                               .kinetic = now.kineticEnergy + now.rotationalEnergy,
                               .potential = now.potentialEnergy,
                               .fields = now.fieldEnergy}),
                  std::nullopt);
    }
    const sim::Statistics end = simulation->statistics();
    EXPECT_GT(end.contacts, 700U);
    EXPECT_LT(end.overlapMean, 3e-3);
    const sim::State state = simulation->snapshot();
    glm::dvec3 mean{};
    for (std::uint32_t id = 0; id < state.count(); ++id) mean += velocityOf(state, id) / 343.0;
    double squares = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        squares += std::pow(glm::distance(velocityOf(state, id), mean), 2) / 343;
        EXPECT_LT(glm::length(positionOf(state, id)), 0.6);
    }
    EXPECT_LT(std::sqrt(squares), 2e-3);
    EXPECT_LT(glm::length(mean), 0.02);
}

INSTANTIATE_TEST_SUITE_P(Seeds, AttractedHeap, testing::Values(5, 6, 7, 8));

}  // namespace
}  // namespace spherule::physics
