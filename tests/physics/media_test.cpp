// Drag in media that move, in each model: wind, vortices, and several media at a place.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "field_support.h"
#include "scene/quality.h"

namespace spherule::physics {
namespace {

class Media : public testing::TestWithParam<scene::Model> {};

scene::Drag randomMedium(scene::Random& random, bool vortex) {
    scene::Drag drag{.density = random.uniform(20, 100), .velocity = random.uniform(0.5, 5) * randomDirection(random)};
    if (vortex)
        drag.vortex = scene::Vortex{.centre = randomDirection(random),
                                    .axis = randomDirection(random),
                                    .speed = random.uniform(-6, 6),
                                    .core = random.uniform(0.3, 1.5)};
    return drag;
}

Motion flight(const scene::Forces& forces, scene::Model model, const Motion& start, double seconds) {
    scene::Scene scene = oneSphere(model, start.x, start.v);
    scene.forces = forces;
    const auto simulation = simulate(scene);
    run(*simulation, seconds);
    return {placeOf(*simulation), speedOf(*simulation)};
}

// The speed w relative to the wind falls as 1 / (c t), where c w^2 is the deceleration. It ends where a substep changes
// the velocity by half a unit of float32.
TEST_P(Media, WindTakesSpheresAlong) {
    scene::Random random(1);
    constexpr double c = 0.5 * 1e8 * std::numbers::pi * fieldRadius * fieldRadius / fieldMass;  // 1/m
    for (int k = 0; k < 10; ++k) {
        const glm::dvec3 wind = random.uniform(0.1, 4) * randomDirection(random);
        const Motion end = flight({.fields = {scene::Drag{.density = 1e5, .coefficient = 1e3, .velocity = wind}}},
                                  GetParam(), {{}, 5.0 * randomDirection(random)}, 0.5);
        const double rounding = std::sqrt(6e-8 * glm::length(wind) / (c / 480));
        EXPECT_LT(glm::distance(end.v, wind), 1.1 / (c * 0.5) + rounding);
        EXPECT_LT(rounding, 2e-5);
    }
}

// v = u + sqrt(g / c) g / |g|, where c |w|^2 is the acceleration by drag at the relative speed w.
TEST_P(Media, TerminalVelocityIsRelativeToTheWind) {
    scene::Random random(2);
    for (int k = 0; k < 10; ++k) {
        const glm::dvec3 gravity = random.uniform(5, 20) * randomDirection(random);
        const scene::Drag drag{.density = random.uniform(500, 5000), .velocity = 5.0 * randomDirection(random)};
        const double c =
            0.5 * drag.density * drag.coefficient * std::numbers::pi * fieldRadius * fieldRadius / fieldMass;
        const glm::dvec3 expected = drag.velocity + glm::normalize(gravity) * std::sqrt(glm::length(gravity) / c);
        const Motion end = flight({.gravity = gravity, .fields = {drag}}, GetParam(), {{}, {}}, 6);
        EXPECT_LT(glm::distance(end.v, expected), 1e-5 * glm::length(expected));
    }
}

// From rest, v = v_t tanh(g t / v_t) relative to the wind.
TEST_P(Media, FallInAnUpdraughtFollowsTheTangent) {
    constexpr double terminal = 48.158;
    scene::Scene scene = oneSphere(GetParam(), {}, {0, 0, 20});
    scene.forces = {.gravity = {0, 0, -earth}, .fields = {scene::Drag{.velocity = {0, 0, 20}}}};
    const auto simulation = simulate(scene);
    for (int second = 1; second <= 20; ++second) {
        run(*simulation, 1);
        const double expected = terminal * std::tanh(earth * second / terminal);
        EXPECT_NEAR(20 - speedOf(*simulation).z, expected, 1e-3 * expected) << second << " s";
    }
}

// An observer who moves along sees the same motion: Galilei.
TEST_P(Media, MovingObserversSeeTheSame) {
    scene::Random random(3);
    for (int k = 0; k < 10; ++k) {
        const glm::dvec3 observer = 3.0 * randomDirection(random);
        const Motion start{randomDirection(random), 3.0 * randomDirection(random)};
        scene::Forces forces{.gravity = 5.0 * randomDirection(random),
                             .fields = {randomMedium(random, false), randomMedium(random, false)}};
        const Motion still = flight(forces, GetParam(), start, 1);
        for (scene::Field& field : forces.fields) std::get<scene::Drag>(field).velocity += observer;
        const Motion moving = flight(forces, GetParam(), {start.x, start.v + observer}, 1);
        EXPECT_LT(glm::distance(moving.v, still.v + observer), 2e-5);
        EXPECT_LT(glm::distance(moving.x, still.x + observer), 2e-5);
    }
}

TEST_P(Media, TurnedScenesHaveTurnedMotions) {
    scene::Random random(4);
    for (int k = 0; k < 10; ++k) {
        const glm::dmat3 turn = glm::mat3_cast(glm::angleAxis(random.uniform(0, 3), randomDirection(random)));
        const Motion start{randomDirection(random), 3.0 * randomDirection(random)};
        scene::Forces forces{.gravity = 5.0 * randomDirection(random), .fields = {randomMedium(random, true)}};
        const Motion one = flight(forces, GetParam(), start, 1);
        forces.gravity = turn * forces.gravity;
        auto& drag = std::get<scene::Drag>(forces.fields[0]);
        drag.velocity = turn * drag.velocity;
        drag.vortex->centre = turn * drag.vortex->centre;
        drag.vortex->axis = turn * drag.vortex->axis;
        const Motion other = flight(forces, GetParam(), {turn * start.x, turn * start.v}, 1);
        EXPECT_LT(glm::distance(other.v, turn * one.v), 2e-5);
        EXPECT_LT(glm::distance(other.x, turn * one.x), 2e-5);
    }
}

TEST_P(Media, OrderDoesNotMatter) {
    scene::Random random(5);
    for (int k = 0; k < 10; ++k) {
        const Motion start{randomDirection(random), 3.0 * randomDirection(random)};
        scene::Forces forces{.gravity = 5.0 * randomDirection(random),
                             .fields = {randomMedium(random, true), randomMedium(random, false),
                                        scene::Spring{.stiffness = 2, .damping = 0.3}, randomMedium(random, true)}};
        const Motion one = flight(forces, GetParam(), start, 1);
        std::ranges::reverse(forces.fields);
        const Motion other = flight(forces, GetParam(), start, 1);
        EXPECT_LT(glm::distance(other.v, one.v), 2e-5);
        EXPECT_LT(glm::distance(other.x, one.x), 2e-5);
    }
}

// A hundred times as dense as the sphere: a substep is far longer than the motion takes. At the end the forces balance.
TEST_P(Media, StrongMediaStayStableAndBalance) {
    scene::Random random(6);
    for (int k = 0; k < 10; ++k) {
        scene::Forces forces{.gravity = 10.0 * randomDirection(random), .fields = {}};
        double fastest = 0;
        for (int medium = 0; medium < 3; ++medium) {
            const scene::Drag drag{.density = 1e5,
                                   .coefficient = random.uniform(1, 20),
                                   .velocity = random.uniform(0, 3) * randomDirection(random)};
            fastest = std::max(fastest, glm::length(drag.velocity));
            forces.fields.emplace_back(drag);
        }
        const Motion start{{}, 2.0 * randomDirection(random)};
        scene::Scene scene = oneSphere(GetParam(), start.x, start.v);
        scene.forces = forces;
        const auto simulation = simulate(scene);
        for (int step = 0; step < 60; ++step) {
            run(*simulation, scene.step);
            EXPECT_LT(glm::length(speedOf(*simulation)), std::max(fastest, 2.0) + 0.1);
        }
        run(*simulation, 1);
        double largest = 0;
        for (const scene::Field& field : forces.fields)
            largest = std::max(largest, glm::length(dragForce(std::get<scene::Drag>(field), {}, speedOf(*simulation))));
        EXPECT_LT(fieldMass * glm::length(accelerationOf(forces, {}, speedOf(*simulation))), 1e-4 * largest);
    }
}

TEST_P(Media, FlightsFollowTheReference) {
    scene::Random random(7);
    for (int k = 0; k < 8; ++k) {
        const Motion start{2.0 * randomDirection(random), 3.0 * randomDirection(random)};
        const scene::Forces forces{
            .gravity = 3.0 * randomDirection(random),
            .fields = {randomMedium(random, true), randomMedium(random, false),
                       scene::Attraction{2.0 * randomDirection(random), random.uniform(1, 4), 0.5},
                       scene::Spring{randomDirection(random), random.uniform(1, 5), random.uniform(0, 1)},
                       scene::Buoyancy{.density = random.uniform(500, 2000), .surface = randomDirection(random)}}};
        const Motion expected = integrated(forces, start, 2);
        const Motion end = flight(forces, GetParam(), start, 2);
        // An error of h / 2 in a change of velocity: drag uses the speed at the beginning of a substep.
        EXPECT_LT(glm::distance(end.x, expected.x), 1e-2);
        EXPECT_LT(glm::distance(end.v, expected.v), 1e-2);
    }
}

// A damped spring holds a sphere in a vortex: it stretches until it bears the drag.
TEST_P(Media, AVortexPushesASphereOnASpring) {
    scene::Random random(8);
    for (int k = 0; k < 12; ++k) {
        scene::Drag drag{.density = 1000, .velocity = random.uniform(0, 1) * randomDirection(random)};
        const double core = random.uniform(0.2, 1);
        const glm::dvec3 axis = randomDirection(random);
        const glm::dvec3 out = glm::normalize(glm::cross(axis, randomDirection(random)));
        const glm::dvec3 centre = randomDirection(random);
        drag.vortex = scene::Vortex{centre, axis, random.uniform(0.5, 3) * (k % 2 == 0 ? 1 : -1), core};
        const glm::dvec3 anchor = centre + (k % 3 == 0 ? 0.5 : 2.0) * core * out + random.uniform(-1, 1) * axis;
        const scene::Spring spring{anchor, 100, 20};
        scene::Scene scene = oneSphere(GetParam(), anchor, {});
        scene.forces.fields = {spring, drag};
        const auto simulation = simulate(scene);
        run(*simulation, 6);
        const glm::dvec3 x = placeOf(*simulation);
        const glm::dvec3 expected = dragForce(drag, x, {});
        EXPECT_LT(glm::distance(spring.stiffness * (x - anchor), expected), 1e-3 * glm::length(expected) + 1e-4) << k;
        EXPECT_GT(glm::length(expected), 0.05);
        EXPECT_LT(glm::length(speedOf(*simulation)), 1e-3);
    }
}

INSTANTIATE_TEST_SUITE_P(Of, Media, testing::ValuesIn(fieldModels),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

}  // namespace
}  // namespace spherule::physics
