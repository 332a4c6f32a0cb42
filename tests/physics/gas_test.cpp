// Gases of the model `fast` in a closed box, with the substeps that it chooses: compared with a simulation of exact
// impacts.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
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

constexpr std::uint32_t count = 500;
constexpr double radius = 0.05;           // m
const double spread = getenv("SP") ? atof(getenv("SP")) : 1;              // m/s, standard deviation of the velocities along each axis
const double unit = radius / spread;  // s
constexpr std::array<std::uint64_t, 3> seeds = {1, 2, 3};

// Spheres on a lattice of cubes with a sphere in each corner and on each face, with random velocities.
scene::Scene gas(double density, std::uint64_t seed, double pairRestitution, double wallRestitution) {
    const double side = std::cbrt(count * 4.0 / 3.0 * std::numbers::pi / density) * radius;
    scene::Scene scene = measure::openSpace(side);
    scene.bounds.open.fill(false);
    setRestitution(scene, pairRestitution);
    scene.bounds.material = addMaterial(scene, {.name = "wall"});
    scene::MaterialPair& wall = scene.pairs.emplace_back();
    wall.b = scene.bounds.material;
    wall.restitution = wallRestitution;
    constexpr std::uint32_t cubes = 5;  // along each axis
    const double pitch = (side - 2 * radius) / (cubes - 0.5);
    constexpr std::array<std::array<int, 3>, 4> places = {
        {{0, 0, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}}};  // half pitches
    scene::Random random(seed);
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::uint32_t cube = k / 4;
        const std::array<std::uint32_t, 3> at = {cube % cubes, cube / cubes % cubes, cube / (cubes * cubes)};
        scene::Sphere sphere;
        sphere.radius = static_cast<float>(radius);
        glm::dvec3 velocity;
        for (int axis = 0; axis < 3; ++axis) {
            const auto one = static_cast<std::size_t>(axis);
            sphere.position[axis] = radius - side / 2 + pitch * (at.at(one) + 0.5 * places.at(k % 4).at(one));
            velocity[axis] = spread * random.normal();
        }
        sphere.velocity = glm::vec3(velocity);
        scene.spheres.push_back(sphere);
    }
    scene.quality = {.model = scene::Model::Fast, .substepsFixed = false};
    scene.quality.substeps = static_cast<std::uint32_t>(scene::defaultSubsteps(scene));
    return scene;
}

reference::HardSphereGas exact(const scene::Scene& scene) {
    std::vector<reference::HardSphere> spheres;
    for (const scene::Sphere& sphere : scene.spheres) spheres.push_back({sphere.position, glm::dvec3(sphere.velocity)});
    const double side = scene.bounds.max.x - scene.bounds.min.x;
    return {spheres, side, radius, scene.materials.front().restitution, *scene.pairs.front().restitution};
}

double meanSquaredSpeed(const sim::State& state) {
    double sum = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id) sum += glm::dot(velocityOf(state, id), velocityOf(state, id));
    return sum / state.count();
}

// A gas that loses energy in impacts cools by Haff's law: v^2 = v0^2 / (1 + t / tau)^2. Returns 1 / (tau v0), which is
// in proportion to the number of impacts per path (1/m).
double coolingBetween(double before, double after, double seconds) {
    return (1 / std::sqrt(after) - 1 / std::sqrt(before)) / seconds;
}

struct Cooling {
    double measured = 0;
    double expected = 0;
};

Cooling cooling(const scene::Scene& scene, double settling, double seconds) {
    auto reference = exact(scene);
    reference.run(settling);
    const double expectedBefore = reference.meanSquaredSpeed();
    reference.run(seconds);
    const auto simulation = simulate(scene);
    run(*simulation, settling);
    const double before = meanSquaredSpeed(simulation->snapshot());
    run(*simulation, seconds);
    const double after = meanSquaredSpeed(simulation->snapshot());
    std::printf("    substeps %u  v2 %.4f ref %.4f\n", simulation->substeps(), after / before,
                reference.meanSquaredSpeed() / expectedBefore);
    return {coolingBetween(before, after, seconds),
            coolingBetween(expectedBefore, reference.meanSquaredSpeed(), seconds)};
}

// Long enough for 10,000 impacts on the walls.
double pressureTime(double density) {
    return (density < 0.07 ? 240 : density < 0.15 ? 160 : density < 0.25 ? 60 : density < 0.35 ? 40 : 25) * unit;
}
double coolingTime(double density) {
    return (density < 0.15 ? 60 : 15) * unit;
}

class Gas : public testing::TestWithParam<double> {};

// Each impact on a wall takes the same share of the energy across the wall, and other impacts take none. So the cooling
// of the gas is in proportion to the impacts on the walls, and to the pressure.
TEST_P(Gas, HasTheWallPressureOfHardSpheres) {
    constexpr double wallRestitution = 0.98;
    const double density = GetParam();
    double sum = 0;
    for (const std::uint64_t seed : seeds) {
        const scene::Scene scene = gas(density, seed, 1, wallRestitution);
        const auto [measured, expected] = cooling(scene, 10 * unit, pressureTime(density));
        std::printf("%g seed %d: %.4f\n", density, (int)seed, measured / expected);
        sum += measured / expected / seeds.size();
    }
    EXPECT_NEAR(sum, 1, 0.05);
    RecordProperty("pressure", std::to_string(sum));
}

TEST_P(Gas, CoolsByHaffsLaw) {
    constexpr double restitution = 0.9;
    const double density = GetParam();
    double sum = 0;
    for (const std::uint64_t seed : seeds) {
        const scene::Scene scene = gas(density, seed, restitution, 1);
        const auto [measured, expected] = cooling(scene, 0, coolingTime(density));
        std::printf("%g seed %d: %.4f\n", density, (int)seed, measured / expected);
        sum += measured / expected / seeds.size();
    }
    EXPECT_NEAR(sum, 1, 0.03);
    RecordProperty("cooling", std::to_string(sum));
}

INSTANTIATE_TEST_SUITE_P(Of, Gas, testing::Values(0.05, 0.1, 0.2, 0.3, 0.4), [](const auto& parameter) {
    return std::to_string(std::lround(100 * parameter.param)) + "Percent";
});

}  // namespace
}  // namespace spherule::physics
