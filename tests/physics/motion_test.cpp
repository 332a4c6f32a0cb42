// Obstacles that move, in each model, against a frame in which they rest, against exact formulas, and against events in
// double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <spdlog/fmt/fmt.h>
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
constexpr double pi = std::numbers::pi;

glm::dvec3 randomDirection(scene::Random& random) {
    return glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
}

// Steps of one substep of 1/480 s; `accurate` with substeps of 1/48,000 s.
scene::Scene space(Model model) {
    scene::Scene scene = fineStepSpace(40);
    scene.quality = {.model = model, .substeps = model == Model::Accurate ? 100U : 1U};
    return scene;
}

struct State {
    glm::dvec3 x{};
    glm::dvec3 v{};
    glm::dvec3 spin{};
};

State stateOf(sim::Simulation& simulation, std::size_t id = 0) {
    const sim::State state = simulation.snapshot();
    return {glm::dvec3(glm::vec3(state.position[id])) + simulation.scene().bounds.centre(),
            glm::dvec3(glm::vec3(state.velocity[id])), glm::dvec3(glm::vec3(state.spin[id]))};
}

scene::Obstacle box(const scene::Box& corners, const scene::Motion& motion) {
    return {.shape = scene::boxShape(corners), .colour = "", .motion = motion};
}

class Motion : public testing::TestWithParam<Model> {
  protected:
    [[nodiscard]] static bool soft() { return GetParam() == Model::Accurate; }
};

// An obstacle at a constant velocity: in the frame in which it rests, the sphere moves as at the same obstacle at rest.
TEST_P(Motion, AtAConstantVelocityIsAFrameAtRest) {
    scene::Random random(51);
    double worst = 0;  // of the velocity, over the speed of approach
    for (int k = 0; k < (soft() ? 6 : 24); ++k) {
        const glm::dvec3 normal = randomDirection(random);
        const glm::dvec3 moves = randomDirection(random) * random.uniform(0, 5);
        const glm::dvec3 approach = -normal * random.uniform(0.5, 3) + randomDirection(random) * random.uniform(0, 0.5);
        const double e = k % 3 == 0 ? 1 : random.uniform(0, 1);
        const double friction = k % 2 == 0 ? 0 : random.uniform(0, 0.6);
        const double gap = -glm::dot(approach, normal) * random.uniform(0.005, 0.02);
        const scene::ShapePointer shape =
            k % 4 < 2 ? scene::planeShape({}, normal)
                      : scene::placedShape(
                            scene::boxShape({{-1, -1, -2}, {1, 1, 0}}),
                            {.axis = glm::cross({0, 0, 1}, normal), .degrees = std::acos(normal.z) * 180 / pi}, {});
        State ends[2];
        for (const bool moving : {false, true}) {
            scene::Scene scene = space(GetParam());
            addSphere(scene, normal * (radius + gap), radius, approach + (moving ? moves : glm::dvec3(0)));
            scene.spheres[0].spin = glm::vec3(3, -4, 5);
            setRestitution(scene, e);
            setFriction(scene, friction);
            scene.obstacles.push_back({.shape = shape, .colour = ""});
            if (moving) scene.obstacles[0].motion = scene::Motion{.velocity = moves};
            const auto simulation = simulate(scene);
            run(*simulation, 0.05);
            ends[moving ? 1 : 0] = stateOf(*simulation);
            if (moving) ends[1].x -= moves * simulation->time();
        }
        ends[1].v -= moves;
        worst = std::max({worst, glm::distance(ends[0].v, ends[1].v) / glm::length(approach),
                          glm::distance(ends[0].spin, ends[1].spin) * radius / glm::length(approach),
                          glm::distance(ends[0].x, ends[1].x) / glm::length(approach) / 0.05});
    }
    EXPECT_LT(worst, soft() ? 1e-3 : 1e-5);
    RecordProperty("worst", std::to_string(worst * 1e9) + "e-9");
}

// The obstacle of a case, in motion.
struct Rebound {
    scene::Obstacle obstacle;
    double time = 0;  // of the contact, s
    State after;      // by the law of impacts
};

// Follows a sphere on a straight path until it touches the obstacle: an event in double precision, without friction.
std::optional<Rebound> reboundOf(const scene::Obstacle& obstacle, const State& start, double e) {
    const auto gap = [&](double t) { return obstacle.distance(start.x + start.v * t, t) - radius; };
    constexpr double step = 1e-4;
    double low = 0;
    if (gap(0) < 1e-3) return std::nullopt;
    while (low < 0.3 && gap(low + step) > 0) low += step;
    if (low >= 0.3) return std::nullopt;
    double high = low + step;
    for (int k = 0; k < 60; ++k) (gap(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
    const glm::dvec3 x = start.x + start.v * low;
    glm::dvec3 normal(0);
    constexpr double d = 1e-6;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 by(0);
        by[axis] = d;
        normal[axis] = obstacle.distance(x + by, low) - obstacle.distance(x - by, low);
    }
    normal = glm::normalize(normal);
    // The speed of the surface along its normal: the rate at which the distance of a point at rest falls.
    const double speed = -(obstacle.distance(x, low + d) - obstacle.distance(x, low - d)) / (2 * d);
    const double approach = glm::dot(start.v, normal) - speed;
    if (approach > -0.3) return std::nullopt;
    return Rebound{obstacle, low, {x, start.v - (1 + e) * approach * normal, {}}};
}

// Spheres that meet boxes, cylinders and capsules which turn, swing and move.
TEST_P(Motion, ReboundsFromTurningShapesAreThoseOfTheLawOfImpacts) {
    scene::Random random(52);
    double worst = 0;
    int met = 0;
    while (met < (soft() ? 12 : 60)) {
        const glm::dvec3 half = randomDirection(random) * random.uniform(0.2, 0.6);
        const std::string ends = fmt::format(R"("from":[{},{},{}],"to":[{},{},{}],"radius":{})", -half.x, -half.y,
                                             -half.z, half.x, half.y, half.z, random.uniform(0.1, 0.4));
        const std::string shapes[] = {
            fmt::format(R"({{"box":{{"min":[-{0},-{1},-{2}],"max":[{0},{1},{2}]}}}})", random.uniform(0.1, 0.6),
                        random.uniform(0.1, 0.6), random.uniform(0.1, 0.6)),
            R"({"cylinder":{)" + ends + "}}", R"({"capsule":{)" + ends + "}}"};
        scene::Obstacle obstacle = obstacleFrom(shapes[met % 3]);
        scene::Motion motion{.velocity = randomDirection(random) * random.uniform(0, 1),
                             .spin = randomDirection(random) * random.uniform(0, 4),
                             .pivot = randomDirection(random) * random.uniform(0, 0.5)};
        if (met % 2 == 1)
            motion.oscillations.push_back({.amplitude = randomDirection(random) * 0.02,
                                           .swing = randomDirection(random) * 0.1,
                                           .frequency = random.uniform(1, 4),
                                           .phase = random.uniform(-180, 180)});
        obstacle.motion = motion;
        const glm::dvec3 from = randomDirection(random) * 1.2;
        const State start{from, (randomDirection(random) * 0.3 - from) * random.uniform(2, 6), {}};
        const double e = random.uniform(0, 1);
        const auto expected = reboundOf(obstacle, start, e);
        if (!expected) continue;
        // Not if it is met again soon.
        const double seconds = expected->time + 0.02;
        bool again = false;
        for (double t = expected->time + 1e-3; t < seconds; t += 1e-3)
            again =
                again || obstacle.distance(expected->after.x + expected->after.v * (t - expected->time), t) < radius;
        if (again) continue;
        ++met;
        scene::Scene scene = space(GetParam());
        addSphere(scene, start.x, radius, start.v);
        setRestitution(scene, e);
        scene.obstacles.push_back(obstacle);
        if (soft()) scene.quality.substeps = 300;
        const auto simulation = simulate(scene);
        run(*simulation, seconds);
        const State end = stateOf(*simulation);
        const double speed = glm::length(start.v);
        worst = std::max(worst, glm::distance(end.v, expected->after.v) / speed);
        // The velocity of an oscillation is constant in a substep.
        const double late = motion.oscillations.empty() ? 0 : 50 * scene.step / scene.quality.substeps;
        EXPECT_LT(glm::distance(end.v, expected->after.v), (soft() ? 0.03 : 0.01) * speed + late) << met;
    }
    RecordProperty("worst", std::to_string(worst * 1e6) + "e-6");
}

// Spheres on a plate that shakes, from random moments on: the error of the first rebound, over its approach, is below
// 1 % in the mean.
TEST_P(Motion, ReboundsFromAShakenPlate) {
    scene::Random random(53);
    constexpr double amplitude = 0.01;  // m
    constexpr double frequency = 10;    // Hz
    const int cases = soft() ? 10 : 40;
    double sum = 0;
    for (int k = 0; k < cases; ++k) {
        scene::Motion motion;
        motion.oscillations.push_back(
            {.amplitude = {0, 0, amplitude}, .frequency = frequency, .phase = random.uniform(-180, 180)});
        const scene::Obstacle plate = box({{-1, -1, -1}, {1, 1, 0}}, motion);
        const State start{{0, 0, radius + 0.03}, {0, 0, -random.uniform(1, 3)}, {}};
        const double e = random.uniform(0.2, 1);
        const auto expected = reboundOf(plate, start, e);
        if (!expected) continue;
        scene::Scene scene = space(GetParam());
        addSphere(scene, start.x, radius, start.v);
        setRestitution(scene, e);
        scene.obstacles.push_back(plate);
        if (soft()) scene.quality.substeps = 300;
        const auto simulation = simulate(scene);
        run(*simulation, expected->time + 0.005);
        sum += glm::distance(stateOf(*simulation).v, expected->after.v) / glm::distance(start.v, expected->after.v);
    }
    EXPECT_LT(sum / cases, soft() ? 0.02 : 0.01);
    RecordProperty("mean", std::to_string(sum / cases * 1e6) + "e-6");
}

// A sphere at rest on a belt of speed u rolls after t = 2 u / (7 mu g), at 2 u / 7.
TEST_P(Motion, SphereOnABeltBeginsToRoll) {
    scene::Random random(54);
    for (int k = 0; k < 4; ++k) {
        const double turn = random.uniform(0, 2 * pi);
        const glm::dvec3 along(std::cos(turn), std::sin(turn), 0);
        const double speed = random.uniform(0.5, 2);
        const double friction = random.uniform(0.1, 0.5);
        scene::Scene scene = space(GetParam());
        scene.forces.gravity = {0, 0, -earth};
        if (soft()) scene.quality.substeps = 400;  // overlaps shorten the lever
        setRestitution(scene, 0);
        setFriction(scene, friction);
        // The part of the belt's velocity across the surface does not count.
        scene::Motion belt{.belt = speed * along + glm::dvec3(0, 0, 0.5)};
        scene.obstacles.push_back(
            k % 2 == 0 ? box({{-9, -9, -1}, {9, 9, 0}}, belt)
                       : scene::Obstacle{.shape = scene::planeShape({}, {0, 0, 1}), .colour = "", .motion = belt});
        addSphere(scene, {0, 0, radius}, radius);
        const auto simulation = simulate(scene);
        const double rolls = 2 * speed / (7 * friction * earth);
        run(*simulation, 0.5 * rolls);
        const double time = simulation->time();
        EXPECT_NEAR(glm::dot(stateOf(*simulation).v, along), friction * earth * time, 0.01 * 2 * speed / 7);
        run(*simulation, 1.2 * rolls - time);
        const State end = stateOf(*simulation);
        EXPECT_NEAR(glm::dot(end.v, along), 2 * speed / 7, 0.01 * 2 * speed / 7);
        EXPECT_LT(glm::length(end.v - along * glm::dot(end.v, along)), 0.01 * speed);
        EXPECT_NEAR(glm::length(end.spin) * radius, speed * 5 / 7, 0.01 * speed * 5 / 7);
    }
}

// A sphere on a plate that shakes by A sin(w t) leaves it at the phase whose sine is g / (A w^2). The force between
// them falls to zero there, in proportion to the sine.
TEST_P(Motion, SphereLeavesAShakenPlate) {
    constexpr double amplitude = 0.01;  // m
    for (const double frequency : {6.0, 8.0, 12.0}) {
        const double rate = 2 * pi * frequency;
        scene::Scene scene = space(GetParam());
        scene.forces.gravity = {0, 0, -earth};
        scene.step = 1.0 / 3840;
        if (soft()) scene.quality.substeps = 50;
        setRestitution(scene, 0);
        scene.contactSums = true;
        // It begins where the plate is lowest, and at rest.
        scene::Motion motion{.begin = 0.1};
        motion.oscillations.push_back({.amplitude = {0, 0, amplitude}, .frequency = frequency, .phase = -90});
        scene.obstacles.push_back(box({{-1, -1, -1}, {1, 1, 0}}, motion));
        addSphere(scene, {0, 0, radius}, radius);
        const auto simulation = simulate(scene);
        run(*simulation, 0.1);
        const double weight = earth / static_cast<double>(simulation->snapshot().velocity[0].w);
        const auto impulse = [&] { return -simulation->readContactSums().loads.at(scene::faceCount).impulse.z; };
        double before = impulse();
        double sums[5] = {};  // of 1, s, f, s s, s f: s is the sine of the phase, f the force
        for (double force = 1; simulation->time() < 0.1 + 0.5 / frequency && force > 0.1 * weight;) {
            run(*simulation, scene.step);
            const double now = impulse();
            force = (now - before) / scene.step;
            before = now;
            // The plate has a constant velocity in a substep. It changes at the beginning of the substep.
            const double time = simulation->time() - 0.1 - (soft() ? 0.5 : 1) * scene.step;
            const double sine = std::sin(rate * time - 0.5 * pi);
            if (force > 0.6 * weight || force < 0.15 * weight) continue;
            const double terms[] = {1, sine, force, sine * sine, sine * force};
            for (int k = 0; k < 5; ++k) sums[k] += terms[k];
        }
        ASSERT_GT(sums[0], 3) << frequency;
        const double slope = (sums[0] * sums[4] - sums[1] * sums[2]) / (sums[0] * sums[3] - sums[1] * sums[1]);
        const double zero = (sums[1] - sums[2] / slope) / sums[0];
        EXPECT_NEAR(zero, earth / (amplitude * rate * rate), 0.01 * earth / (amplitude * rate * rate)) << frequency;
    }
}

// A closed box carries a sphere for a minute, at a constant velocity: the sphere lies in it as in one at rest.
TEST_P(Motion, SphereRestsInABoxThatMoves) {
    const double seconds = soft() ? 4 : 60;
    scene::Scene scene = space(GetParam());
    scene.forces.gravity = {0, 0, -earth};
    setRestitution(scene, 0.3);
    setFriction(scene, 0.3);
    // The motion in a substep is exact in float32, so that positions of spheres and box are rounded alike.
    const glm::dvec3 velocity = glm::dvec3(480, -240, 120) / 4096.0;
    scene.obstacles.push_back({.shape = scene::boxShape({{-0.3, -0.3, 0}, {0.3, 0.3, 0.6}}, true),
                               .colour = "",
                               .motion = scene::Motion{.velocity = velocity}});
    addSphere(scene, {0.1, 0.05, radius}, radius, velocity);
    const auto simulation = simulate(scene);
    const auto place = [&] { return stateOf(*simulation).x - velocity * simulation->time(); };
    run(*simulation, 1);
    const glm::dvec3 settled = place();
    double drift = 0;
    while (simulation->time() < seconds) {
        run(*simulation, 0.5);
        drift = std::max(drift, glm::distance(place(), settled));
    }
    EXPECT_LT(drift, 1e-3 * radius);
    RecordProperty("drift", std::to_string(drift * 1e9) + "e-9 m");
}

// A blade that turns at up to 30 m/s throws the spheres in its way forward: none passes through it.
TEST_P(Motion, NoSpherePassesAFastBlade) {
    scene::Scene scene = fineStepSpace(8);
    scene.quality = {.model = GetParam(), .substeps = soft() ? 300U : 1U};
    setRestitution(scene, 0.5);
    // Two blades through the axis, as long as the spheres are far from it; a sphere stays in its quarter.
    constexpr double spin = 10;  // rad/s
    for (const double turn : {0.0, 90.0})
        scene.obstacles.push_back(
            {.shape = scene::placedShape(scene::boxShape({{-3, -0.01, -1}, {3, 0.01, 1}}), {.degrees = turn}, {}),
             .colour = "",
             .motion = scene::Motion{.spin = {0, 0, spin}}});
    scene::Random random(55);
    while (scene.spheres.size() < (soft() ? 40 : 200)) {
        const glm::dvec3 x(random.uniform(-2.5, 2.5), random.uniform(-2.5, 2.5), random.uniform(-0.8, 0.8));
        if (std::min(std::abs(x.x), std::abs(x.y)) > 0.12) addSphere(scene, x, 0.03);
    }
    scene.sphereContacts = false;
    const auto simulation = simulate(scene);
    const auto quarterOf = [&](const glm::dvec3& x) {
        const double angle = std::atan2(x.y, x.x) - spin * simulation->time();
        return static_cast<int>(std::floor(angle / (pi / 2) + 400)) % 4;
    };
    std::vector<int> quarters;
    for (const scene::Sphere& sphere : scene.spheres) quarters.push_back(quarterOf(sphere.position));
    int passed = 0;
    for (int k = 0; k < 60; ++k) {
        run(*simulation, 0.005);
        const sim::State state = simulation->snapshot();
        for (std::uint32_t id = 0; id < state.count(); ++id) {
            const glm::dvec3 x(glm::vec3(state.position[id]));
            // Beyond the blades, spheres fly on.
            if (std::hypot(x.x, x.y) > 2.9 || std::abs(x.z) > 0.95) quarters[id] = -1;
            if (quarters[id] >= 0 && quarterOf(x) != quarters[id]) {
                ++passed;
                quarters[id] = -1;
            }
        }
    }
    EXPECT_EQ(passed, 0);
}

INSTANTIATE_TEST_SUITE_P(Of, Motion, testing::Values(Model::Fast, Model::Balanced, Model::Accurate),
                         [](const auto& test) { return std::string(scene::nameOf(test.param)); });

}  // namespace
}  // namespace spherule::physics
