// Impacts and gases of the model `fast`, with the substeps that it chooses. The gases are compared with a simulation of
// exact impacts.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "event_driven.h"
#include "scene/quality.h"
#include "scene/random.h"
#include "support.h"

namespace spherule::physics {
namespace {

constexpr double radius = 0.05;  // m
constexpr int phases = 25;       // instants within a substep at which spheres meet

void chooseFast(scene::Scene& scene) {
    scene.quality = {.model = scene::Model::Fast, .substepsFixed = false};
    scene.quality.substeps = static_cast<std::uint32_t>(scene::defaultSubsteps(scene));
}

glm::dvec3 randomDirection(scene::Random& random) {
    return glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
}

glm::dvec3 angularMomentumOf(const sim::State& state) {
    glm::dvec3 sum{};
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        const double r = radiusOf(state, id);
        sum += massOf(state, id) *
               (glm::cross(positionOf(state, id), velocityOf(state, id)) + 0.4 * r * r * spinOf(state, id));
    }
    return sum;
}

double angularScaleOf(const sim::State& state) {
    double sum = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id)
        sum += massOf(state, id) * glm::length(glm::cross(positionOf(state, id), velocityOf(state, id)));
    return sum;
}

struct PairCase {
    double restitution = 0;
    double otherRadius = radius;  // m
    double otherDensity = 1000;   // kg/m^3
    double friction = 0;
};

// Two spheres in a random direction and a moving frame. They meet at 0 to 84 degrees to their line of centres, more
// often at large angles, at `phase` (0 to 1) of the eleventh substep.
struct Meeting {
    scene::Scene scene;
    glm::dvec3 normal{};    // at the impact, from the second sphere to the first
    glm::dvec3 approach{};  // m/s, relative velocity
};

Meeting meeting(const PairCase& one, double phase, scene::Random& random) {
    Meeting meeting;
    scene::Scene& scene = meeting.scene;
    scene = measure::openSpace(4);
    scene.materials = {
        {.density = 1000, .restitution = one.restitution, .friction = one.friction},
        {.name = "other", .density = one.otherDensity, .restitution = one.restitution, .friction = one.friction}};
    chooseFast(scene);
    const double substep = scene.step / scene.quality.substeps;
    meeting.normal = randomDirection(random);
    const glm::dvec3 across = glm::normalize(glm::cross(meeting.normal, randomDirection(random)));
    const double angle = 84 * std::sqrt(random.uniform()) * std::numbers::pi / 180;
    meeting.approach = random.uniform(1.6, 2.4) * (std::sin(angle) * across - std::cos(angle) * meeting.normal);
    const glm::dvec3 drift = randomDirection(random);
    const double flight = (10 + phase) * substep;
    const glm::dvec3 first = 0.2 * randomDirection(random) - drift * flight;
    const glm::dvec3 apart = meeting.normal * (radius + one.otherRadius) - meeting.approach * flight;
    measure::addSphere(scene, first, radius, drift + 0.5 * meeting.approach);
    measure::addSphere(scene, first - apart, one.otherRadius, drift - 0.5 * meeting.approach, 1);
    return meeting;
}

class FastPair : public testing::TestWithParam<PairCase> {};

TEST_P(FastPair, MeetsExactlyAtAnyPhase) {
    scene::Random random(5);
    double restitution = 0;
    double linear = 0;
    double angular = 0;
    double sideways = 0;
    for (int phase = 0; phase < phases; ++phase) {
        for (int direction = 0; direction < 8; ++direction) {
            const Meeting one = meeting(GetParam(), (phase + 0.5) / phases, random);
            const auto simulation = simulate(one.scene);
            const sim::State before = simulation->snapshot();
            run(*simulation, 0.3);
            const sim::State after = simulation->snapshot();
            const double speed = glm::length(one.approach);
            const glm::dvec3 parting = velocityOf(after, 0) - velocityOf(after, 1);
            const double expected = -GetParam().restitution * glm::dot(one.approach, one.normal);
            restitution = std::max(restitution, std::abs(glm::dot(parting, one.normal) - expected) / speed);
            linear = std::max(linear, glm::length(momentumOf(after) - momentumOf(before)) / momentumScale(before));
            angular = std::max(
                angular, glm::length(angularMomentumOf(after) - angularMomentumOf(before)) / angularScaleOf(before));
            const glm::dvec3 change = parting - one.approach;
            if (GetParam().friction == 0)
                sideways = std::max(sideways, glm::length(change - one.normal * glm::dot(change, one.normal)) / speed);
            EXPECT_LT(kineticEnergyOf(after), kineticEnergyOf(before) * (1 + 1e-6 * support::errorOfDivisions()));
        }
    }
    EXPECT_LT(restitution, 2e-5);
    EXPECT_LT(sideways, 2e-5);
    EXPECT_LT(linear, 1e-6);
    EXPECT_LT(angular, 1e-5);
    RecordProperty("restitution", std::to_string(restitution * 1e6) + "e-6");
    RecordProperty("sideways", std::to_string(sideways * 1e6) + "e-6");
    RecordProperty("angular", std::to_string(angular * 1e6) + "e-6");
}

INSTANTIATE_TEST_SUITE_P(Of, FastPair,
                         testing::Values(PairCase{.restitution = 0}, PairCase{.restitution = 0.5},
                                         PairCase{.restitution = 1}, PairCase{.restitution = 0.9, .friction = 0.3},
                                         PairCase{.restitution = 0, .friction = 0.3},
                                         PairCase{.restitution = 0.9, .otherDensity = 8000, .friction = 0.3},
                                         PairCase{.restitution = 0.9, .otherRadius = 0.1, .friction = 0.3}));

// A sphere that bounces is where the parabolas lead it, also in time.
TEST(FastWall, ThrowsSpheresBackAtTheMomentOfImpact) {
    constexpr double restitution = 0.8;
    constexpr double fall = 0.4;  // m
    constexpr double seconds = 0.6;
    for (int phase = 0; phase < phases; ++phase) {
        scene::Scene scene = measure::closedBox(2);
        setRestitution(scene, restitution);
        chooseFast(scene);
        const double substep = scene.step / scene.quality.substeps;
        const double impact = std::sqrt(2 * fall / earth) + (phase + 0.5) / phases * substep;
        const double height = 0.5 * earth * impact * impact;
        measure::addSphere(scene, {0, 0, radius - 1 + height}, radius, {0.5, 0, 0});
        const auto simulation = simulate(scene);
        run(*simulation, seconds);
        const double since = seconds - impact;
        const double expected = restitution * earth * impact * since - 0.5 * earth * since * since;
        EXPECT_NEAR(positionOf(simulation->snapshot(), 0).z + 1 - radius, expected, 1e-5) << phase;
    }
}

constexpr std::uint32_t count = 500;

struct GasCase {
    double density = 0;  // volume of the spheres per volume of the box
    double spread = 1;   // m/s, standard deviation of the velocities along each axis

    [[nodiscard]] double unit() const { return radius / spread; }  // s
};

// Spheres on a lattice of cubes with a sphere in each corner and on each face, with random velocities.
scene::Scene gas(const GasCase& one, std::uint64_t seed, double pairRestitution, double wallRestitution) {
    const double side = std::cbrt(count * 4.0 / 3.0 * std::numbers::pi / one.density) * radius;
    scene::Scene scene = measure::openSpace(side);
    scene.bounds.open.fill(false);
    setRestitution(scene, pairRestitution);
    scene.bounds.material = addMaterial(scene, {.name = "wall"});
    scene::MaterialPair& wall = scene.pairs.emplace_back();
    wall.b = scene.bounds.material;
    wall.restitution = wallRestitution;
    constexpr std::uint32_t cubes = 5;  // along each axis
    const double pitch = (side - 2 * radius) / (cubes - 0.5);
    constexpr std::array<glm::dvec3, 4> places = {{{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}}};
    scene::Random random(seed);
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::uint32_t cube = k / 4;
        const glm::dvec3 corner(cube % cubes, cube / cubes % cubes, cube / (cubes * cubes));
        const glm::dvec3 position = radius - side / 2 + pitch * (corner + places.at(k % 4));
        measure::addSphere(scene, position, radius,
                           one.spread * glm::dvec3(random.normal(), random.normal(), random.normal()));
    }
    chooseFast(scene);
    return scene;
}

double sideOf(const scene::Scene& scene) {
    return scene.bounds.max.x - scene.bounds.min.x;
}

reference::HardSphereGas exact(const scene::Scene& scene) {
    std::vector<reference::HardSphere> spheres;
    for (const scene::Sphere& sphere : scene.spheres) spheres.push_back({sphere.position, glm::dvec3(sphere.velocity)});
    return {spheres, sideOf(scene), radius, scene.materials.front().restitution, *scene.pairs.front().restitution};
}

double meanSquaredSpeed(const sim::State& state) {
    double sum = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id) sum += glm::dot(velocityOf(state, id), velocityOf(state, id));
    return sum / state.count();
}

// Haff's law: a gas whose impacts take a share of its energy cools as v^2 = v0^2 / (1 + t / tau)^2. Returns
// 1 / (tau v0), which is in proportion to the number of impacts per path (1/m).
double coolingBetween(double before, double after, double seconds) {
    return (1 / std::sqrt(after) - 1 / std::sqrt(before)) / seconds;
}

// Returns the ratio of cooling in the simulation to cooling in the reference, from the same start. `settling`: time
// before the measurement (s). `seconds`: duration of the measurement.
double relativeCooling(const scene::Scene& scene, double settling, double seconds) {
    settling = std::round(settling / scene.step) * scene.step;
    seconds = std::round(seconds / scene.step) * scene.step;
    auto reference = exact(scene);
    reference.run(settling);
    const double expectedBefore = reference.meanSquaredSpeed();
    reference.run(seconds);
    const auto simulation = simulate(scene);
    run(*simulation, settling);
    const double before = meanSquaredSpeed(simulation->snapshot());
    run(*simulation, seconds);
    return coolingBetween(before, meanSquaredSpeed(simulation->snapshot()), seconds) /
           coolingBetween(expectedBefore, reference.meanSquaredSpeed(), seconds);
}

class FastGas : public testing::TestWithParam<GasCase> {
  protected:
    [[nodiscard]] static double density() { return GetParam().density; }
    // Long enough for 10,000 impacts on the walls.
    [[nodiscard]] static double wallTime() { return (density() < 0.15 ? 14 / density() : 11 / density()) * unit(); }
    // Long enough to lose three quarters of the energy.
    [[nodiscard]] static double coolingTime() { return (density() < 0.25 ? 4 / density() : 10) * unit(); }
    [[nodiscard]] static double unit() { return GetParam().unit(); }
};

// Each impact on a wall takes a fixed share of the energy across the wall, and other impacts take none. So the gas
// cools in proportion to the impacts on the walls, and to the pressure.
TEST_P(FastGas, HasTheWallPressureOfHardSpheres) {
    constexpr double wallRestitution = 0.98;
    constexpr std::uint64_t seeds = 3;
    double mean = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed)
        mean += relativeCooling(gas(GetParam(), seed, 1, wallRestitution), 10 * unit(), wallTime()) / seeds;
    EXPECT_NEAR(mean, 1, 0.05);
    RecordProperty("pressure", std::to_string(mean));
}

TEST_P(FastGas, CoolsByHaffsLaw) {
    constexpr double restitution = 0.9;
    constexpr std::uint64_t seeds = 16;
    double mean = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed)
        mean += relativeCooling(gas(GetParam(), seed, restitution, 1), 0, coolingTime()) / seeds;
    EXPECT_NEAR(mean, 1, 0.03);
    RecordProperty("cooling", std::to_string(mean));
}

// Spheres of one size divide the same numbers in each impact. An error of this division therefore has the same sign in
// all impacts. With perturbed arithmetic the energy changes by 1.7e-4 for each ulp at a density of 0.4, and a division
// and two products err by up to 4 ulp.
TEST_P(FastGas, KeepsItsEnergyAmongElasticWalls) {
    const scene::Scene scene = gas(GetParam(), 4, 1, 1);
    const auto simulation = simulate(scene);
    const double before = meanSquaredSpeed(simulation->snapshot());
    run(*simulation, 60 * unit());
    EXPECT_NEAR(meanSquaredSpeed(simulation->snapshot()) / before, 1, support::errorOfDivisions() == 1 ? 1e-4 : 7e-4);
}

INSTANTIATE_TEST_SUITE_P(Of, FastGas,
                         testing::Values(GasCase{.density = 0.05}, GasCase{.density = 0.1}, GasCase{.density = 0.2},
                                         GasCase{.density = 0.3}, GasCase{.density = 0.4},
                                         GasCase{.density = 0.4, .spread = 0.75}, GasCase{.density = 0.4, .spread = 4}),
                         [](const auto& parameter) {
                             return std::to_string(std::lround(100 * parameter.param.density)) + "PercentAt" +
                                    std::to_string(std::lround(100 * parameter.param.spread)) + "CmPerS";
                         });

// The virial theorem: the impulses between the spheres and at the walls balance over a long time.
TEST(HardSphereGas, ObeysTheVirialTheorem) {
    for (const double density : {0.1, 0.4}) {
        const scene::Scene scene = gas({.density = density}, 1, 1, 1);
        auto reference = exact(scene);
        const double speed = reference.meanSquaredSpeed();
        const double seconds = 10 / density * radius;
        reference.run(seconds);
        EXPECT_NEAR(reference.meanSquaredSpeed() / speed, 1, 1e-9);
        const double inside = count * speed + 2 * radius * reference.pairImpulse() / seconds;
        const double atWalls = (sideOf(scene) / 2 - radius) * reference.wallImpulse() / seconds;
        EXPECT_NEAR(atWalls / inside, 1, 0.01);
        EXPECT_GT(reference.wallImpacts(), 5000U);
    }
}

}  // namespace
}  // namespace spherule::physics
