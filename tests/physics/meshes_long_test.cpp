// Obstacles of triangles over many contacts: a bottle that keeps fast spheres, and a bed in a box of triangles.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "mesh_support.h"
#include "scene/quality.h"
#include "scene/random.h"
#include "scene/shapes.h"

namespace spherule::physics {
namespace {

using scene::Mesh;

class MeshesLong : public testing::TestWithParam<scene::Model> {};

// 1,000 spheres at 100 m/s, until they have hit the wall about a million times.
TEST_P(MeshesLong, KeepFastSpheresInABottle) {
    flyInBottle(GetParam(), 6, 1000, GetParam() == scene::Model::Accurate ? 1000 : 50, 0.1);
}

double meanHeight(scene::Model model, bool mesh, unsigned seed) {
    scene::Scene scene = fineStepBox(1);
    scene.quality = {.model = model, .substeps = model == scene::Model::Accurate ? 60U : 4U};
    scene.step = 1.0 / 120;
    scene.sleep.enabled = false;
    setRestitution(scene, 0.3);
    measure::setFriction(scene, 0.3);
    const glm::dvec3 half(0.25, 0.25, 0.5);
    scene.bounds.min = -half - (mesh ? 0.1 : 0.0);
    scene.bounds.max = half + (mesh ? 0.1 : 0.0);
    if (mesh) scene.obstacles.push_back(meshOf(support::boxOf(-half, half), Mesh::Form::Hollow));
    scene::Random random(seed);
    for (int k = 0; k < 343; ++k)
        measure::addSphere(scene,
                           0.068 * (glm::dvec3(k % 7, k / 7 % 7, k / 49) - 3.0) +
                               0.008 * glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)),
                           0.025);
    const auto simulation = simulate(scene);
    run(*simulation, 3);
    double sum = 0;
    const sim::State state = simulation->snapshot();
    for (std::size_t k = 0; k < scene.spheres.size(); ++k) sum += placeOf(state, scene, k).z + half.z;
    return sum / static_cast<double>(scene.spheres.size());
}

// The mean heights differ by less than two standard errors, over five seeds.
TEST_P(MeshesLong, HoldABedAsTheBoundsDo) {
    constexpr unsigned seeds = 5;
    double sums[2]{};
    double squares[2]{};
    for (unsigned seed = 1; seed <= seeds; ++seed)
        for (const bool mesh : {false, true}) {
            const double height = meanHeight(GetParam(), mesh, seed + (mesh ? 100 : 0));
            sums[mesh ? 1 : 0] += height;
            squares[mesh ? 1 : 0] += height * height;
        }
    const auto variance = [&](int k) { return (squares[k] - sums[k] * sums[k] / seeds) / (seeds - 1); };
    const double error = std::sqrt((variance(0) + variance(1)) / seeds);
    const double difference = (sums[1] - sums[0]) / seeds;
    EXPECT_LT(std::abs(difference), 2 * error) << "bounds " << sums[0] / seeds << ", mesh " << sums[1] / seeds;
    RecordProperty("difference", std::to_string(difference / error) + " standard errors");
}

// Returns the angle by which the centre of mass of a bed lies ahead of the lowest place of a drum that turns, as mean
// over the time (degrees).
double slopeIn(scene::Model model, scene::Obstacle drum, std::uint64_t seed) {
    scene::Scene scene = fineStepSpace(1);
    scene.quality = {.model = model, .substeps = model == scene::Model::Accurate ? 20U : 1U};
    scene.forces.gravity = {0, -measure::earth, 0};
    setRestitution(scene, 0.3);
    measure::setFriction(scene, 0.5);
    scene.materials[0].rollingResistance = 0.1;
    drum.motion = scene::Motion{.spin = {0, 0, 1}};
    scene.obstacles.push_back(drum);
    scene::Random random(seed);
    for (int k = 0; k < 300; ++k) {
        const glm::dvec3 jitter(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const glm::dvec3 place(k % 10 - 4.5, k / 10 % 10 - 4.5, k / 100 - 1);
        measure::addSphere(scene, 0.032 * place + 0.0005 * jitter, 0.015);
    }
    const auto simulation = simulate(scene);
    run(*simulation, 3);
    glm::dvec3 centre(0);
    for (int k = 0; k < 200; ++k) {
        run(*simulation, 0.02);
        const sim::State state = simulation->snapshot();
        for (std::size_t id = 0; id < scene.spheres.size(); ++id) centre += placeOf(state, scene, id);
    }
    return std::atan2(centre.x, -centre.y) * 180 / std::numbers::pi;
}

// The slope in a drum of 64 flat sides is the slope in a round one within a degree, over three seeds.
TEST_P(MeshesLong, TurnABedAsARoundDrumDoes) {
    const scene::Obstacle round =
        obstacleFrom(R"({"cylinder": {"from": [0, 0, -0.05], "to": [0, 0, 0.05], "radius": 0.25, "hollow": true}})");
    const scene::Obstacle sides =
        meshOf(support::lathe({{0, -0.05}, {0.25, -0.05}, {0.25, 0.05}, {0, 0.05}}, 64), Mesh::Form::Hollow);
    double slopes[2]{};
    for (const std::uint64_t seed : {91U, 92U, 93U}) {
        slopes[0] += slopeIn(GetParam(), round, seed) / 3;
        slopes[1] += slopeIn(GetParam(), sides, seed) / 3;
    }
    EXPECT_GT(slopes[0], 10);
    EXPECT_NEAR(slopes[1], slopes[0], 1);
    RecordProperty("slopes", std::to_string(slopes[0]) + " and " + std::to_string(slopes[1]) + " degrees");
}

INSTANTIATE_TEST_SUITE_P(Of, MeshesLong, testing::ValuesIn(models),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

}  // namespace
}  // namespace spherule::physics
