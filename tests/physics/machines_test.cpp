// Scenes that come with the program and have moving obstacles do what their descriptions say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "scene/catalog.h"
#include "scene_support.h"
#include "support.h"

namespace spherule::physics {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double degree = pi / 180;

struct Body {
    glm::dvec3 x{};
    glm::dvec3 v{};
    double radius = 0;
};

std::vector<Body> bodiesOf(sim::Simulation& simulation) {
    const sim::State state = simulation.snapshot();
    std::vector<Body> bodies;
    for (std::uint32_t k = 0; k < state.count(); ++k)
        bodies.push_back({sim::positionOf(state, k) + simulation.scene().bounds.centre(), sim::velocityOf(state, k),
                          sim::radiusOf(state, k)});
    return bodies;
}

template <class Wanted>
std::size_t count(const std::vector<Body>& bodies, Wanted wanted) {
    return static_cast<std::size_t>(std::ranges::count_if(bodies, wanted));
}

class Machines : public testing::TestWithParam<unsigned> {  // by seed
  protected:
    // No sphere sleeps in it.
    static std::unique_ptr<sim::Simulation> machine(const std::string& name) {
        return simulate(named(name, {.seed = GetParam(), .noSleep = true}));
    }
};

// A bed in a drum, in the plane that the axis pierces at x = 0 and z = `axis`.
struct Bed {
    double surface = 0;  // degrees: slope of the highest spheres
    double weight = 0;   // degrees: the middle of the spheres from the vertical below the axis
};

Bed bedIn(const std::vector<Body>& bodies, double axis) {
    constexpr int strips = 8;
    std::vector<double> top(strips, -1);  // m, over strips of 0.1 m
    glm::dvec3 sum(0);
    for (const Body& body : bodies) {
        sum += body.x;
        const double strip = std::floor((body.x.x + 0.4) / 0.1);
        if (strip < 0 || strip >= strips) continue;
        double& highest = top[static_cast<std::size_t>(strip)];
        highest = std::max(highest, body.x.z);
    }
    double xz = 0;
    double xx = 0;
    for (int k = 0; k < strips; ++k) {
        const double x = -0.35 + 0.1 * k;
        xz += x * top[static_cast<std::size_t>(k)];
        xx += x * x;
    }
    const glm::dvec3 middle = sum / static_cast<double>(bodies.size());
    return {-std::atan(xz / xx) / degree, -std::atan2(middle.x, axis - middle.z) / degree};
}

// The slope of a bed that rolls is the same all the time. It is above 15 degrees, the least at which spheres without
// rolling resistance come to rest on each other, and below the angle of their friction with resistance, 40 degrees.
TEST_P(Machines, DrumHasASteadySlope) {
    const auto simulation = machine("drum");
    run(*simulation, 3);
    Bed mean[2]{};
    constexpr int samples = 10;
    for (Bed& half : mean) {
        for (int k = 0; k < samples; ++k) {
            run(*simulation, 0.25);
            const Bed now = bedIn(bodiesOf(*simulation), 1.22);
            half.surface += now.surface / samples;
            half.weight += now.weight / samples;
        }
    }
    RecordProperty("surface", std::to_string(mean[0].surface) + " " + std::to_string(mean[1].surface));
    RecordProperty("weight", std::to_string(mean[0].weight) + " " + std::to_string(mean[1].weight));
    EXPECT_NEAR(mean[0].surface, mean[1].surface, 2);
    for (const Bed& half : mean) {
        EXPECT_GT(half.surface, 15);
        EXPECT_LT(half.surface, 42);
        EXPECT_NEAR(half.surface, half.weight, 5);
    }
}

TEST_P(Machines, ConveyorCarriesAtTheSpeedOfItsBelts) {
    const auto simulation = machine("conveyor");
    const glm::dvec3 along = glm::normalize(glm::dvec3(0, 1, 0.19));
    double speed = 0;  // m/s, on the second belt, one diameter above it at most
    unsigned carried = 0;
    for (int sample = 0; sample < 20; ++sample) {
        run(*simulation, sample == 0 ? 10 : 0.2);
        for (const Body& body : bodiesOf(*simulation)) {
            if (body.x.x < 1.35 || body.x.x > 1.95 || body.x.y < 0.9 || body.x.y > 1.8) continue;
            speed += glm::dot(body.v, along);
            ++carried;
        }
    }
    speed /= carried;
    RecordProperty("speed", std::to_string(speed));
    EXPECT_GT(carried, 200U);
    EXPECT_NEAR(speed, 0.6, 0.02 * 0.6);
    run(*simulation, 30);
    const std::vector<Body> bodies = bodiesOf(*simulation);
    EXPECT_EQ(bodies.size(), 800U);
    EXPECT_EQ(count(bodies, [](const Body& body) { return body.x.z < 0.1; }), 0U);
    EXPECT_GT(count(bodies, [](const Body& body) { return body.x.x < -0.83 && body.x.y < 0.3; }), 150U);  // the hopper
}

// Returns how deep a sphere is in the nearest of eight lifters that have turned with the mill (m).
double depthInLifters(const Body& body, const glm::dvec2& fromAxis, double turned) {
    double depth = -1;
    for (int k = 0; k < 8; ++k) {
        const double angle = turned + k * pi / 4;  // of the lifter from the vertical below the axis
        const glm::dvec2 out(-std::sin(angle), -std::cos(angle));
        const double outwards = glm::dot(fromAxis, out);
        const double across = fromAxis.x * out.y - fromAxis.y * out.x;
        const glm::dvec2 beyond(std::max(0.0, 0.83 - outwards), std::max(0.0, std::abs(across) - 0.05));
        depth = std::max(depth, body.radius - glm::length(beyond));
    }
    return depth;
}

TEST_P(Machines, LiftersRaiseTheBallsOfTheMill) {
    const auto simulation = machine("ball-mill");
    double highest = -1;  // m above the axis, of the balls
    double deepest = 0;   // radii, in a lifter or the drum
    double time = 0;
    for (int sample = 0; sample < 24; ++sample) {
        run(*simulation, 0.25);
        time += 0.25;
        for (const Body& body : bodiesOf(*simulation)) {
            const glm::dvec2 fromAxis(body.x.x, body.x.z - 1.15);
            if (body.radius > 0.05) highest = std::max(highest, fromAxis.y);
            const double inDrum = std::max(glm::length(fromAxis) - 0.95, std::abs(body.x.y) - 0.3) + body.radius;
            deepest = std::max({deepest, inDrum / body.radius, depthInLifters(body, fromAxis, 2 * time) / body.radius});
        }
    }
    RecordProperty("highest", std::to_string(highest));
    RecordProperty("deepest", std::to_string(deepest));
    EXPECT_GT(highest, 0.3);
    EXPECT_LT(deepest, 0.3);
}

TEST_P(Machines, MarblesRunForEver) {
    const auto simulation = machine("marble-run");
    constexpr std::size_t marbles = 21;
    std::vector<bool> lifted(marbles, false);
    std::vector<unsigned> laps(marbles, 0);
    for (int sample = 0; sample < 600; ++sample) {
        run(*simulation, 0.1);
        const std::vector<Body> bodies = bodiesOf(*simulation);
        ASSERT_EQ(bodies.size(), marbles);
        for (std::size_t k = 0; k < marbles; ++k) {
            if (bodies[k].x.z > 1.55) lifted[k] = true;
            if (!lifted[k] || bodies[k].x.z > 0.5 || bodies[k].x.x < 0.9) continue;
            lifted[k] = false;  // it has left the rails for the floor
            ++laps[k];
        }
    }
    const auto [least, most] = std::ranges::minmax(laps);
    RecordProperty("laps", std::to_string(least) + " to " + std::to_string(most));
    EXPECT_GE(least, 3U);
}

TEST_P(Machines, PressMovesTheBedWithItsLid) {
    const auto simulation = machine("press");
    const auto top = [&] {  // of the bed (m)
        double highest = 0;
        for (const Body& body : bodiesOf(*simulation)) highest = std::max(highest, body.x.z + body.radius);
        return highest;
    };
    const auto overlap = [&] { return simulation->statistics().overlapMean; };
    run(*simulation, 1.2);
    for (int sample = 0; sample < 12; ++sample) {  // down
        const double lid = 1.25 - 0.55 * sample * 0.25 / 3;
        EXPECT_LT(top(), lid + 0.01) << sample;
        run(*simulation, 0.25);
    }
    run(*simulation, 1);
    EXPECT_NEAR(top(), 0.70, 0.01);
    run(*simulation, 2.3);  // it is up again
    RecordProperty("overlap", std::to_string(overlap()));
    EXPECT_NEAR(top(), 0.70, 0.03);
    EXPECT_LT(overlap(), 0.02);
    for (const Body& body : bodiesOf(*simulation)) {
        EXPECT_LT(std::max(std::abs(body.x.x), std::abs(body.x.y)), 0.6);
        EXPECT_GT(body.x.z, 0);
    }
}

// All balls stay in the box, and some rise in the tube at any time.
TEST_P(Machines, ScrewLiftsBallsForEver) {
    const auto simulation = machine("screw");
    run(*simulation, 6);
    const glm::dvec3 along(std::cos(42 * degree), 0, std::sin(42 * degree));
    double rising = 0;
    for (int sample = 0; sample < 40; ++sample) {
        run(*simulation, 0.25);
        const std::vector<Body> bodies = bodiesOf(*simulation);
        ASSERT_EQ(bodies.size(), 480U);
        for (const Body& body : bodies) {
            const glm::dvec3 from = body.x - glm::dvec3(-0.72, 0, 0.16);
            const double place = glm::dot(from, along);
            if (place < 0.4 || place > 0.9 || glm::length(from - along * place) > 0.17) continue;
            rising += glm::dot(body.v, along) / 40;
        }
    }
    RecordProperty("rising", std::to_string(rising));
    EXPECT_GT(rising, 0.5);  // m/s, summed over the balls in the tube
}

// Spheres per second out of a screw feeder, below an emitter that keeps its trough full. `turns`: per second.
double screwFlow(double turns, std::uint64_t seed) {
    constexpr const char* text = R"({{
        "bounds": {{"min": [0, -0.18, -0.18], "max": [1.2, 0.18, 0.5]}}, "sleep": {{"enabled": false}},
        "materials": [{{"density": 1200, "restitution": 0.3, "friction": 0.3}}],
        "obstacles": [
            {{"mesh": {{"solid": true}}, "rotation": {{"axis": [0, 1, 0], "degrees": 90}}, "translation": [0.01, 0, 0],
              "motion": {{"spin": [{}, 0, 0]}}}},
            {{"cylinder": {{"from": [0.4, 0, 0], "to": [1, 0, 0], "radius": 0.172, "open": true}}}},
            {{"disc": {{"centre": [0.4, 0, 0], "normal": [1, 0, 0], "radius": 0.7, "hole": 0.172}}}}],
        "emitters": [{{"box": {{"min": [0.03, -0.15, 0.35], "max": [0.36, 0.15, 0.35]}}, "rate": 500, "seed": {},
                      "velocity": [0, 0, -1], "radius": {{"uniform": {{"min": 0.022, "max": 0.026}}}}}}],
        "sinks": [{{"region": {{"min": [1.02, -1, -1], "max": [2, 1, 1]}}}}]}})";
    v1::Scene message = scene::testing::parsed(fmt::format(text, -2 * pi * turns, seed));
    const v1::Scene screw = scene::testing::parsed(std::string(scene::embeddedScene("screw", "cpu").value()));
    message.mutable_obstacles(0)->mutable_mesh()->set_data(screw.obstacles(1).mesh().data());
    const auto simulation = simulate(support::valueOf(scene::build(message)));
    const double fills = 2 + 4 / turns;  // s; the tube has three turns
    run(*simulation, fills);
    const std::uint64_t before = simulation->statistics().sinks[0].taken.spheres;
    EXPECT_GT(simulation->statistics().emitters[0].blocked, 0U) << "the trough is full";
    run(*simulation, 4 / turns);
    return static_cast<double>(simulation->statistics().sinks[0].taken.spheres - before) / (4 / turns);
}

// The flow is linear in the speed, and below the volume that the blade sweeps. P. Owen and P. Cleary, "Prediction of
// screw conveyor performance using the Discrete Element Method", Powder Technology 193 (2009).
TEST_P(Machines, ScrewFeederIsLinearInItsSpeed) {
    const double slow = screwFlow(0.5, GetParam());
    const double fast = screwFlow(1, GetParam());
    const double swept = pi * (0.172 * 0.172 - 0.031 * 0.031) * 0.2;  // m^3 per turn
    constexpr double densest = 0.64;
    const double meanVolume = 4 * pi / 3 * 0.024 * 0.024 * 0.024;
    const double bound = 0.5 * densest * swept / meanVolume;
    RecordProperty("rate", fmt::format("{} and {} per second, at most {}", slow, fast, bound));
    EXPECT_NEAR(fast / (2 * slow), 1, 0.1);
    EXPECT_LT(slow, bound);
    EXPECT_GT(slow, 0.3 * bound);
}

// The floor throws the piston up, and the balls stay below it.
TEST_P(Machines, PistonStaysOnItsBalls) {
    const auto simulation = machine("piston");
    double highest = -9;
    double lowest = 9;
    for (int sample = 0; sample < 80; ++sample) {
        run(*simulation, 0.25);
        const double piston = 1.45 + simulation->scene().obstacles[0].motion->drive->place;
        if (sample > 8) {
            highest = std::max(highest, piston);
            lowest = std::min(lowest, piston);
        }
        for (const Body& body : bodiesOf(*simulation)) EXPECT_LT(body.x.z, piston + 0.01);
    }
    RecordProperty("piston", std::to_string(lowest) + " to " + std::to_string(highest));
    EXPECT_GT(lowest, 0.5);
    EXPECT_GT(highest, lowest + 0.05);
    EXPECT_LT(highest, 2);
}

// The flow follows the law of Beverloo: n = C f sqrt(g) (D - k d)^2.5 / V spheres per second, with C = 0.58 and k
// = 1.4. f is the share of the volume that spheres fill, D is the outlet and V is the volume of a mean sphere.
TEST_P(Machines, SiloFlowsAtTheRateOfItsOutletAndStops) {
    const auto simulation = machine("silo");
    const auto below = [&] {  // the gate
        return count(bodiesOf(*simulation), [](const Body& body) { return body.x.z < 1.04; });
    };
    run(*simulation, 1.5);
    EXPECT_EQ(below(), 0U);
    run(*simulation, 1);  // the gate is open from 1.9 s to 4.1 s
    const std::size_t early = below();
    run(*simulation, 1.5);
    const double rate = static_cast<double>(below() - early) / 1.5;
    constexpr double d = 0.078;
    constexpr double filled = 0.58;
    const double law = 0.58 * filled * std::sqrt(9.81) * std::pow(0.44 - 1.4 * d, 2.5) / (pi / 6 * d * d * d);
    RecordProperty("rate", std::to_string(rate) + " by the law " + std::to_string(law));
    EXPECT_NEAR(rate, law, 0.2 * law);
    run(*simulation, 1.6);  // the gate is closed from 4.6 s to 7.5 s
    const std::size_t passed = below();
    RecordProperty("passed", std::to_string(passed));
    run(*simulation, 1.6);
    EXPECT_EQ(below(), passed);
    EXPECT_EQ(bodiesOf(*simulation).size(), 3'000U);
    EXPECT_LT(simulation->statistics().overlapMax, 0.2);
}

TEST_P(Machines, SievePartsSmallBallsFromLargeOnes) {
    const auto simulation = machine("sieve");
    run(*simulation, 9);
    const std::vector<Body> bodies = bodiesOf(*simulation);
    ASSERT_EQ(bodies.size(), 1'760U);
    const auto large = [](const Body& body) { return body.radius > 0.03; };
    const auto rolledOff = [](const Body& body) { return body.x.x > 1.34 && body.x.z < 0.6; };  // into the bin there
    const auto fellThrough = [](const Body& body) { return body.x.x < -1.3 && body.x.z < 0.4; };
    const std::size_t small = count(bodies, [&](const Body& body) { return !large(body) && fellThrough(body); });
    RecordProperty("small", std::to_string(small));
    // The bars are above 1 m.
    EXPECT_EQ(count(bodies, [&](const Body& body) { return large(body) && body.x.x < 1.2 && body.x.z < 0.95; }), 0U);
    EXPECT_GT(count(bodies, [&](const Body& body) { return large(body) && rolledOff(body); }), 160U);
    EXPECT_GT(small, 1'200U);
}

TEST_P(Machines, AvalancheComesToRestOnThePlain) {
    const auto simulation = machine("avalanche");
    const auto height = [](const std::vector<Body>& bodies) {
        double sum = 0;
        for (const Body& body : bodies) sum += body.x.z / static_cast<double>(bodies.size());
        return sum;
    };
    run(*simulation, 1);
    std::vector<Body> bodies = bodiesOf(*simulation);
    EXPECT_EQ(count(bodies, [](const Body& body) { return body.x.x < 0.9; }), 3'000U);  // behind the gate
    const double before = height(bodies);
    double last = before;
    for (int second = 0; second < 6; ++second) {
        run(*simulation, 1);
        bodies = bodiesOf(*simulation);
        EXPECT_LT(height(bodies), last + 0.001) << second;
        last = height(bodies);
    }
    double squares = 0;  // of speeds
    for (const Body& body : bodies) squares += glm::dot(body.v, body.v);
    const double speed = std::sqrt(squares / static_cast<double>(bodies.size()));
    const std::size_t plain = count(bodies, [](const Body& body) { return body.x.x > 4; });
    RecordProperty("plain", std::to_string(plain) + " at " + std::to_string(speed) + " m/s");
    EXPECT_EQ(bodies.size(), 3'000U);
    EXPECT_LT(last, before - 2);
    EXPECT_GT(plain, 2'100U);
    EXPECT_LT(speed, 0.5);  // it was 2.7 m/s
    const scene::Obstacle& ground = simulation->scene().obstacles[0];
    EXPECT_EQ(count(bodies, [&](const Body& body) { return ground.distance(body.x, 0) < 0.5 * body.radius; }), 0U);
}

INSTANTIATE_TEST_SUITE_P(Of, Machines, testing::Values(1U, 2U));

}  // namespace
}  // namespace spherule::physics
