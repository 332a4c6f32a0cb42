// Spheres that emitters make and sinks take.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "scene/random.h"
#include "scene_support.h"
#include "support.h"

namespace spherule::physics {
namespace {

using scene::testing::parsed;

scene::Scene sceneOf(const std::string& json) {
    auto built = scene::build(parsed(json));
    if (!built) throw std::invalid_argument(built.error().text());
    return std::move(*built);
}

constexpr const char* jet = R"({{
    "bounds": {{"min": [-1, -1, 0], "max": [1, 1, 4]}}, "sphereContacts": false, "quality": {{"substeps": 1}},
    "step": {step}, "sleep": {{"enabled": false}},
    "emitters": [{{"disc": {{"centre": [0, 0, 3], "normal": [0, 0, 1], "radius": 0.5}}, "rate": {rate},
                  "begin": {begin}, "velocity": [0, 0, {speed}], "radius": {{"constant": 0.005}}}}],
    "sinks": [{{"region": {{"min": [-2, -2, -1], "max": [2, 2, {sink}]}}}}]}})";

// As many spheres are in the air as the fall takes time, whatever the phase and the length of the steps.
TEST(Emitters, KeepAsManySpheresInTheAirAsFallsLast) {
    scene::Random random(11);
    constexpr double g = 9.81;
    for (int k = 0; k < 12; ++k) {
        const double rate = random.uniform(20, 200);
        const double speed = random.uniform(0, 3);
        const double fall = random.uniform(0.5, 2.5);
        const double begin = random.uniform(0, 0.1);
        const double step = random.uniform(0.4, 1) / rate;
        auto simulation =
            simulate(sceneOf(fmt::format(jet, fmt::arg("step", step), fmt::arg("rate", rate), fmt::arg("begin", begin),
                                         fmt::arg("speed", -speed), fmt::arg("sink", 3 - fall))));
        const double inside = rate * (-speed + std::sqrt(speed * speed + 2 * g * fall)) / g;
        run(*simulation, begin + 1);
        for (int look = 0; look < 10; ++look) {
            run(*simulation, 7 * step);
            EXPECT_NEAR(simulation->count(), inside, 2) << rate << " " << speed << " " << fall;
        }
        const sim::Statistics now = simulation->statistics();
        EXPECT_EQ(now.emitters.at(0).born.spheres, now.born);
        EXPECT_EQ(now.sinks.at(0).taken.spheres, now.removed);
        EXPECT_EQ(now.sinks.at(0).byMaterial, (std::vector<std::uint64_t>{now.removed}));
        EXPECT_EQ(now.born, now.spheres + now.removed);
    }
}

// A box, with a ball in it unless it is periodic, into which an emitter throws spheres of two sizes from all sides; a
// sink takes them at the floor.
scene::Scene crowd(scene::Model model, std::uint64_t seed, double rate, const std::string& periodic = "") {
    scene::Scene scene = sceneOf(fmt::format(
        R"({{"bounds": {{"min": [-0.5, -0.5, 0], "max": [0.5, 0.5, 1]{}}}, "quality": {{"model": "{}"}},
        "materials": [{{"friction": 0.4}}],
        "emitters": [{{"box": {{"min": [-0.5, -0.5, 0.3], "max": [0.5, 0.5, 1]}}, "rate": {},
                      "radius": {{"uniform": {{"min": 0.02, "max": 0.04}}}}, "velocitySpread": 1, "seed": {}}}],
        "sinks": [{{"region": {{"min": [-0.5, -0.5, 0], "max": [0.5, 0.5, 0.05]}}}}]}})",
        periodic,
        model == scene::Model::Fast       ? "FAST"
        : model == scene::Model::Balanced ? "BALANCED"
                                          : "ACCURATE",
        rate, seed));
    if (periodic.empty()) scene.obstacles = {obstacleFrom(R"({"sphere": {"centre": [0.1, 0, 0.6], "radius": 0.2}})")};
    return scene;
}

// The deepest overlap of spheres younger than `firstId` with others, walls and the ball, as a share of the radius.
double deepestOfNew(const sim::State& state, const scene::Scene& scene, std::uint64_t firstId) {
    double deepest = 0;
    for (std::uint32_t i = 0; i < state.count(); ++i) {
        if (state.idAt(i) < firstId) continue;
        const glm::dvec3 x = positionOf(state, i);
        const double r = radiusOf(state, i);
        for (std::uint32_t k = 0; k < state.count(); ++k) {
            if (k == i) continue;
            const double gap = glm::length(scene::separation(x, positionOf(state, k), scene.bounds.periods())) - r -
                               radiusOf(state, k);
            deepest = std::max(deepest, -gap / r);
        }
        for (const scene::Obstacle& obstacle : scene.obstacles)
            deepest = std::max(deepest, (r - obstacle.distance(x + scene.bounds.centre(), 0)) / r);
        for (int axis = 0; axis < 3; ++axis)
            if (!scene.bounds.periodic[static_cast<std::size_t>(axis)])
                deepest = std::max(deepest, (std::abs(x[axis]) + r - 0.5) / r);
    }
    return deepest;
}

class Emitters : public testing::TestWithParam<scene::Model> {};

TEST_P(Emitters, NeverMakeASphereInAnother) {
    for (const std::string periodic : {"", R"(, "periodic": ["X", "Y"])"})
        for (const std::uint64_t seed : {1U, 2U}) {
            const scene::Scene scene = crowd(GetParam(), seed, 3000, periodic);
            auto simulation = simulate(scene);
            std::uint64_t before = 0;
            for (int k = 0; k < 40; ++k) {
                ASSERT_TRUE(simulation->step());
                const std::uint64_t next = simulation->population().nextId();
                if (next == before) continue;
                EXPECT_LT(deepestOfNew(simulation->snapshot(), scene, before), 2e-5) << seed << " step " << k;
                before = next;
            }
            const sim::Statistics now = simulation->statistics();
            EXPECT_GT(now.emitters[0].born.spheres, 300U);
            EXPECT_GT(now.emitters[0].blocked, 20U) << "the box is full";
            EXPECT_EQ(now.born, now.spheres + now.removed);
            EXPECT_EQ(now.nonFinite, 0U);
            EXPECT_LT(now.deepest(), 0.5);
        }
}

TEST_P(Emitters, GiveTheSameBitsOnAllDevices) {
    std::optional<std::uint64_t> expected;
    for (const char* const choice : {"software", "cpu:1x1", "cpu:2x4", "cpu:3x8"}) {
        const auto device = compute::openDevice(choice).value();
        auto simulation = simulate(crowd(GetParam(), 5, 600), *device);
        run(*simulation, 0.2);
        const std::uint64_t hash = sim::hashOf(simulation->snapshot());
        EXPECT_EQ(hash, expected.value_or(hash)) << choice;
        expected = hash;
    }
}

TEST_P(Emitters, MakeTheSameSpheresAfterAReset) {
    auto simulation = simulate(crowd(GetParam(), 6, 600));
    run(*simulation, 0.5);
    const sim::State first = simulation->snapshot();
    const sim::Statistics before = simulation->statistics();
    ASSERT_TRUE(simulation->apply(sim::Reset{}));
    EXPECT_EQ(simulation->count(), 0U);
    EXPECT_EQ(simulation->statistics().emitters[0].born.spheres, 0U);
    run(*simulation, 0.5);
    EXPECT_EQ(sim::hashOf(simulation->snapshot()), sim::hashOf(first));
    EXPECT_EQ(simulation->statistics().emitters[0].blocked, before.emitters[0].blocked);
    EXPECT_EQ(simulation->statistics().sinks[0].taken.spheres, before.sinks[0].taken.spheres);
}

TEST_P(Emitters, GoBackWithTheWorld) {
    auto simulation = simulate(crowd(GetParam(), 7, 300));
    run(*simulation, 1.2);  // a state was kept at 1 s
    sim::State broken = simulation->snapshot();
    broken.velocity[0].x = std::numeric_limits<float>::quiet_NaN();
    simulation->upload(broken);
    ASSERT_TRUE(simulation->step());
    ASSERT_TRUE(simulation->counters().nonFinite);
    simulation->rollback();
    auto undisturbed = simulate(crowd(GetParam(), 7, 300));
    run(*undisturbed, simulation->time());
    EXPECT_EQ(simulation->statistics().emitters[0].born.spheres, undisturbed->statistics().emitters[0].born.spheres);
    EXPECT_EQ(simulation->count(), undisturbed->count());
    run(*simulation, 0.5);
    const sim::Statistics now = simulation->statistics();
    EXPECT_EQ(now.born, now.spheres + now.removed);
}

INSTANTIATE_TEST_SUITE_P(Of, Emitters,
                         testing::Values(scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate),
                         [](const auto& model) { return std::string(scene::nameOf(model.param)); });

struct Pour {
    int rate = 0;  // spheres per second
    bool mixed = false;
};

std::ostream& operator<<(std::ostream& out, const Pour& pour) {
    return out << pour.rate << (pour.mixed ? "_mixed" : "_equal");
}

// The mean over columns of two to three diameters of the tops of their highest spheres (m above the floor).
double levelOf(const sim::State& state, const scene::Bounds& bounds, double diameter) {
    const double side = bounds.max.x - bounds.min.x;
    const auto across = static_cast<std::size_t>(side / (2.5 * diameter));
    std::vector<double> tops(across * across);
    const auto columnOf = [&](double from) {
        return std::clamp<std::size_t>(static_cast<std::size_t>(std::max(0.0, from / side) * across), 0, across - 1);
    };
    for (std::uint32_t k = 0; k < state.count(); ++k) {
        const glm::dvec3 place = positionOf(state, k) + bounds.centre() - bounds.min;
        double& top = tops[columnOf(place.y) * across + columnOf(place.x)];
        top = std::max(top, place.z + radiusOf(state, k));
    }
    return std::accumulate(tops.begin(), tops.end(), 0.0) / static_cast<double>(tops.size());
}

class Filling : public testing::TestWithParam<Pour> {};

// An emitter at a height fills a bin up to it, ends, and stays ended while the bed settles.
TEST_P(Filling, ReachesTheHeightOfTheEmitter) {
    constexpr double diameter = 0.03;  // the mean
    const Pour pour = GetParam();
    // A fast one fills a wide bin, or its spheres would lack free places.
    const double side = (pour.rate > 1000 ? 20 : 10) * diameter;
    constexpr double height = 8 * diameter;
    const double smallest = diameter / (pour.mixed ? 3 : 2);
    const double largest = pour.mixed ? 2 * smallest : smallest;
    const std::string radius = pour.mixed ? fmt::format(R"({{"uniform": {{"min": {}, "max": {}}}}})", smallest, largest)
                                          : fmt::format(R"({{"constant": {}}})", smallest);
    for (const int seed : {1, 2, 3}) {
        SCOPED_TRACE(seed);
        auto simulation = simulate(sceneOf(fmt::format(
            R"({{"bounds": {{"min": [0, 0, 0], "max": [{0}, {0}, 0.5]}}, "materials": [{{"restitution": 0.3}}],
            "sleep": {{"enabled": false}},
            "emitters": [{{"box": {{"min": [{1}, {1}, {3}], "max": [{2}, {2}, {3}]}}, "rate": {4}, "radius": {5},
                          "velocity": [0, 0, -1], "untilChoked": 0.2, "seed": {6}}}]}})",
            side, 1.001 * largest, side - 1.001 * largest, height, pour.rate, radius, seed)));
        for (int tenths = 0; tenths < 1000 && !simulation->statistics().emitters[0].ended; ++tenths)
            run(*simulation, 0.1);
        const sim::Statistics ended = simulation->statistics();
        ASSERT_TRUE(ended.emitters[0].ended);
        EXPECT_EQ(ended.emitters[0].waiting, 0U);
        EXPECT_EQ(ended.born, ended.spheres);
        run(*simulation, 1);
        const sim::Statistics later = simulation->statistics();
        EXPECT_EQ(later.born, ended.born);
        EXPECT_EQ(later.emitters[0].blocked, ended.emitters[0].blocked);
        const sim::State state = simulation->snapshot();
        const double level = levelOf(state, simulation->scene().bounds, diameter);
        EXPECT_NEAR(level, height, 1.5 * diameter);
        double volume = 0;
        for (std::uint32_t k = 0; k < state.count(); ++k)
            volume += 4 * std::numbers::pi / 3 * std::pow(radiusOf(state, k), 3);
        EXPECT_GT(volume / (side * side * height), 0.52);
    }
}

INSTANTIATE_TEST_SUITE_P(Of, Filling,
                         testing::Values(Pour{20}, Pour{20, true}, Pour{100}, Pour{100, true}, Pour{500},
                                         Pour{500, true}, Pour{1500}, Pour{1500, true}, Pour{5000}, Pour{5000, true}),
                         [](const auto& pour) { return testing::PrintToString(pour.param); });

// Many more spheres than the grid was made for: it gets more cells, and no sphere is lost.
TEST(Emitters, OutgrowTheirGrid) {
    auto simulation = simulate(sceneOf(
        R"({"bounds": {"min": [-2, -2, 0], "max": [2, 2, 4]}, "groups": [{"radius": {"constant": 0.05},
        "list": {"spheres": [{"position": [0, 0, 1]}]}}], "quality": {"model": "FAST"}})"));
    scene::Scene scene = simulation->scene();
    scene.emitters =
        sceneOf(R"({"bounds": {"min": [-2, -2, 0], "max": [2, 2, 4]}, "emitters": [{"box": {"min": [-2, -2, 0],
        "max": [2, 2, 4]}, "rate": 120000, "total": 20000, "radius": {"constant": 0.05}}]})")
            .emitters;
    scene.groups.emplace_back();
    scene.emitters[0].group = 1;
    scene.emitters[0].expected = 10;
    simulation = simulate(scene);
    const std::uint32_t cells = simulation->plan().grid.all();
    run(*simulation, 0.8);
    EXPECT_GT(simulation->plan().grid.all(), cells);
    const sim::Statistics now = simulation->statistics();
    EXPECT_EQ(now.emitters[0].born.spheres, 20'000U);
    EXPECT_EQ(now.born, 20'001U);
    EXPECT_EQ(now.spheres, 20'001U);
    EXPECT_EQ(simulation->scene().groups[1].count, now.spheres - 1);
    EXPECT_EQ(now.nonFinite, 0U);
}

}  // namespace
}  // namespace spherule::physics
