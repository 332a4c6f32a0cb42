// Obstacles of triangles over many contacts: a bottle that keeps fast spheres, and a bed in a box of triangles.
#include <gtest/gtest.h>

#include <cmath>

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
    const bool accurate = GetParam() == scene::Model::Accurate;
    flyInBottle(GetParam(), accurate ? 0.6 : 6, 1000);
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

INSTANTIATE_TEST_SUITE_P(Of, MeshesLong, testing::ValuesIn(models),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

}  // namespace
}  // namespace spherule::physics
