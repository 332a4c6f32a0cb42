#include <gtest/gtest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "support.h"

namespace spherule::physics {
namespace {

scene::Sphere at(glm::dvec3 position) {
    scene::Sphere sphere;
    sphere.position = position;
    sphere.radius = 0.05F;
    return sphere;
}

void push(sim::Simulation& simulation, std::uint32_t id, glm::dvec3 velocity) {
    const double mass = massOf(simulation.snapshot(), id);
    ASSERT_TRUE(simulation.apply(sim::Push{.target = id, .impulse = mass * velocity}));
}

// A column of balls, one exactly on top of the other, all asleep.
std::unique_ptr<sim::Simulation> sleepingColumn(int height) {
    scene::Scene scene = sleepyBox(2);
    scene.bounds.material = addMaterial(scene, {.restitution = 0});  // a sphere that is pushed away does not come back
    for (int k = 0; k < height; ++k) scene.spheres.push_back(at({0, 0, -0.95 + 0.1 * k}));
    auto simulation = simulate(scene);
    run(*simulation, 3);
    EXPECT_EQ(sleepers(simulation->snapshot()), simulation->count());
    return simulation;
}

TEST(Sleep, DoesNotTakeASphereAtTheTopOfItsFlight) {
    for (const double g : {earth, 0.1, 0.01}) {
        SCOPED_TRACE(g);
        scene::Scene scene = sleepyBox(20);
        scene.gravity = {0, 0, -g};
        scene.spheres.push_back(at({0, 0, 0}));
        const double up = g;  // at the top after one second
        scene.spheres[0].velocity = {0, 0, static_cast<float>(up)};
        const auto simulation = simulate(scene);
        for (int step = 0; step < 120; ++step) {
            run(*simulation, scene.step);
            ASSERT_EQ(sleepers(simulation->snapshot()), 0U) << "in step " << step;
        }
        EXPECT_NEAR(positionOf(simulation->snapshot(), 0).z, 0, 1e-4 * g);
    }
}

// The sphere moves by less than the creep, and is slow at each apex. But it never is slow and supported at the same
// time.
TEST(Sleep, DoesNotTakeASphereThatHopsForEver) {
    scene::Scene scene = sleepyBox(2);
    scene.spheres = {at({0, 0, -0.948})};
    setRestitution(scene, 1);
    const auto simulation = simulate(scene);
    for (int step = 0; step < 120; ++step) {
        run(*simulation, scene.step);
        ASSERT_EQ(sleepers(simulation->snapshot()), 0U) << "in step " << step;
    }
}

TEST(Sleep, EndsWhenATouchingSphereIsPushedSlowly) {
    scene::Scene scene = sleepyBox(2);
    scene.spheres = {at({0, 0, -0.95}), at({0.1, 0, -0.95})};
    const auto simulation = simulate(scene);
    run(*simulation, 1.5);
    ASSERT_EQ(sleepers(simulation->snapshot()), 2U);
    push(*simulation, 0, {0.3, 0, 0});
    run(*simulation, simulation->scene().step);
    const sim::State state = simulation->snapshot();
    EXPECT_NEAR(velocityOf(state, 0).x + velocityOf(state, 1).x, 0.3, 1e-4) << "momentum has gone into a sleeper";
}

TEST(Sleep, EndsWhenASphereIsHit) {
    scene::Scene scene = sleepyBox(2);
    scene.spheres = {at({0, 0, -0.95}), at({0.1, 0, -0.95}), at({-0.8, 0, -0.95})};
    const auto simulation = simulate(scene);
    run(*simulation, 1.5);
    ASSERT_EQ(sleepers(simulation->snapshot()), 3U);
    const sim::State before = simulation->snapshot();
    push(*simulation, 2, {3, 0, 0});
    run(*simulation, 0.5);
    const sim::State after = simulation->snapshot();
    EXPECT_GT(positionOf(after, 0).x, positionOf(before, 0).x + 0.01);
    EXPECT_GT(positionOf(after, 1).x, positionOf(before, 1).x + 0.1) << "the blow goes through the first to the second";
    EXPECT_FALSE(asleep(after, 1));
}

TEST(Sleep, EndsWhenASlowSphereArrives) {
    scene::Scene scene = sleepyBox(2);
    scene.spheres = {at({0, 0, -0.95}), at({-0.3, 0, -0.95})};
    const auto simulation = simulate(scene);
    run(*simulation, 1.5);
    ASSERT_EQ(sleepers(simulation->snapshot()), 2U);
    push(*simulation, 1, {0.2, 0, 0});
    run(*simulation, 1.5);
    const sim::State state = simulation->snapshot();
    EXPECT_NEAR(velocityOf(state, 0).x + velocityOf(state, 1).x, 0.2, 0.002) << "momentum has gone into a sleeper";
}

TEST(Sleep, EndsWhenTheSupportIsRemoved) {
    const auto simulation = sleepingColumn(4);
    push(*simulation, 0, {4, 0, 0});
    run(*simulation, 1);
    const sim::State state = simulation->snapshot();
    EXPECT_LT(positionOf(state, 1).z, -0.85 - 0.04);
    for (std::uint32_t id = 1; id < 4; ++id) EXPECT_LT(positionOf(state, id).z, -0.95 + 0.1 * id - 0.04) << id;
}

TEST(Sleep, EndsWhenTheSupportIsOutOfReachWithinASubstep) {
    const auto simulation = sleepingColumn(4);
    push(*simulation, 0, {40, 0, 0});  // 83 mm a substep
    run(*simulation, 0.08);
    EXPECT_LT(positionOf(simulation->snapshot(), 1).z, -0.95 + 0.1 - 0.025) << "it falls from the first substep on";
    // Each other sphere falls when its support has sunk by the creep (5 mm), after 32 ms.
    run(*simulation, 0.05);
    const sim::State state = simulation->snapshot();
    for (std::uint32_t id = 2; id < 4; ++id) EXPECT_LT(positionOf(state, id).z, -0.95 + 0.1 * id - 0.01) << id;
}

TEST(Sleep, EndsWhenTheSupportCreepsAway) {
    const auto simulation = sleepingColumn(2);
    push(*simulation, 0, {0.025, 0, 0});
    run(*simulation, 5);
    EXPECT_LT(positionOf(simulation->snapshot(), 1).z, -0.95 + 0.01) << "nothing holds it up there";
}

// A fast sphere causes a rebuild of the lists in every substep, before a slow sphere has moved by the margin.
TEST(Sleep, EndsWhenTheSupportCreepsAwayInABusyWorld) {
    scene::Scene scene = sleepyBox(2);
    scene.spheres = {at({0, 0, -0.95}), at({0, 0, -0.85}), at({0.9, 0.9, 0.9})};
    scene.spheres[2].radius = 0.025F;
    scene.bounds.material = addMaterial(scene, {.restitution = 1});
    scene.spheres[2].material = scene.bounds.material;
    scene.spheres[2].velocity = {0, 0, -12};
    const auto simulation = simulate(scene);
    run(*simulation, 3);
    ASSERT_TRUE(asleep(simulation->snapshot(), 0) && asleep(simulation->snapshot(), 1));
    push(*simulation, 0, {0.025, 0, 0});
    const auto rebuilds = simulation->counters().rebuilds;
    run(*simulation, 5);
    EXPECT_GT(simulation->counters().rebuilds, rebuilds + 2000) << "the world is not busy";
    EXPECT_LT(positionOf(simulation->snapshot(), 1).z, -0.95 + 0.01) << "nothing holds it up there";
}

TEST(Sleep, EndsWhenGravityChanges) {
    const auto simulation = sleepingColumn(3);
    ASSERT_TRUE(simulation->apply(sim::Set{.gravity = glm::dvec3(0, 0, 2)}));
    run(*simulation, 0.5);
    const sim::State state = simulation->snapshot();
    for (std::uint32_t id = 0; id < 3; ++id) {
        EXPECT_FALSE(asleep(state, id));
        EXPECT_GT(positionOf(state, id).z, -0.95 + 0.1 * id + 0.2);
    }
}

}  // namespace
}  // namespace spherule::physics
