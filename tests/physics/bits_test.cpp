// Every shipped scene gives the same bits on the CPU with any number of threads, and on Mesa's software renderer.
// SPHERULE_BITS_SECONDS sets the simulated time (s). The default is 0.3 s, and one step with more than 100,000 spheres;
// scenes of up to 2,000 spheres go on to 2 s on the CPU alone. The long test bits_long runs 2 s.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh_support.h"
#include "mixed.h"
#include "scene/quality.h"
#include "scene/random.h"
#include "scene/shapes.h"
#include "support.h"

namespace spherule::physics {
namespace {

constexpr std::uint32_t large = 100'000;

class SceneBits : public testing::TestWithParam<std::string> {};

struct Durations {
    double all = 0;  // s, on all devices
    double cpu = 0;  // s, on the CPU
};

Durations durationsOf(const scene::Scene& scene) {
    const char* const asked = std::getenv("SPHERULE_BITS_SECONDS");
    if (asked != nullptr) return {std::stod(asked), std::stod(asked)};
    if (scene.spheres.size() > large) return {scene.step, scene.step};
    return {0.3, scene.spheres.size() > 2'000 ? 0.3 : 2};
}

TEST_P(SceneBits, AreTheSameOnAllDevices) {
    const scene::Scene scene = named(GetParam());
    const Durations durations = durationsOf(scene);
    std::optional<std::uint64_t> expected;
    std::optional<std::uint64_t> expectedLater;
    for (const char* const choice : {"software", "cpu:1x1", "cpu:2x4", "cpu:3x8", "cpu:8"}) {
        const auto device = compute::openDevice(choice).value();
        auto simulation = simulate(scene, *device);
        run(*simulation, durations.all);
        const std::uint64_t hash = sim::hashOf(simulation->snapshot());
        EXPECT_EQ(hash, expected.value_or(hash)) << choice;
        expected = hash;
        if (!(durations.cpu > durations.all) || std::string_view(choice) == "software") continue;
        run(*simulation, durations.cpu - durations.all);
        const std::uint64_t later = sim::hashOf(simulation->snapshot());
        EXPECT_EQ(later, expectedLater.value_or(later)) << choice;
        expectedLater = later;
    }
}

// 200 spheres of two materials and many sizes, thrown onto an obstacle in a box, with all contact parameters.
scene::Scene mixture(scene::Model model) {
    scene::Scene scene = fineStepBox(0.8);
    scene.materials = {{.name = "a", .friction = 0.4, .rollingResistance = 0.1, .spinningResistance = 0.05},
                       {.name = "b", .density = 2500, .restitution = 0.8, .friction = 0.7}};
    scene.bounds.material = 1;
    scene.obstacles.push_back({scene::boxShape({{-0.2, -0.2, -0.4}, {0.1, 0.1, -0.3}}), 0, ""});
    scene.quality = {.model = model, .substeps = model == scene::Model::Accurate ? 100U : 1U};
    scene::Random random(11);
    for (int k = 0; k < 216; ++k) {
        scene::Sphere sphere;
        sphere.radius = static_cast<float>(random.uniform(0.02, 0.045));
        sphere.material = static_cast<std::uint8_t>(k % 2);
        sphere.position = 0.1 * (glm::dvec3(k % 6, k / 6 % 6, k / 36) - 2.5);
        sphere.position.z += 0.1;
        sphere.velocity = {static_cast<float>(random.uniform(-1, 1)), static_cast<float>(random.uniform(-1, 1)), -1};
        sphere.spin = {static_cast<float>(random.uniform(-9, 9)), 3, static_cast<float>(random.uniform(-9, 9))};
        scene.spheres.push_back(sphere);
    }
    return scene;
}

// A bed below a sphere that is `ratio` times as large as the smallest one. Each size class has its own cells.
scene::Scene mixedBed(scene::Model model, double ratio) {
    scene::Scene scene = bedUnderOne(ratio < 50 ? 200 : 900, ratio);
    scene.materials[0].friction = 0.4;
    scene.quality = {.model = model, .substeps = model == scene::Model::Accurate ? 100U : 4U};
    for (scene::Sphere& sphere : scene.spheres) sphere.velocity.z = -1;
    return scene;
}

// Spheres of several sizes that fall, roll and collide across seams, in bounds that are periodic along x and y.
scene::Scene periodicMixture(scene::Model model, double ratio) {
    scene::Scene scene = mixture(model);
    scene.obstacles.clear();
    scene.obstacles.push_back({scene::planeShape({0, 0, -0.55}, {0, 0, 1}), 0, ""});
    scene.bounds.min = {-0.53, -0.49, -0.6};
    scene.bounds.max = {0.53, 0.49, 0.6};
    scene.bounds.periodic = {true, true, false};
    scene.forces.gravity = {3, -2, -9};
    scene.sleep.enabled = true;
    for (std::size_t k = 0; k < scene.spheres.size(); ++k) {
        scene::Sphere& sphere = scene.spheres[k];
        if (k % 3 == 1) sphere.radius /= static_cast<float>(ratio);
        sphere.position += glm::dvec3(0.27, -0.24, -0.2);
        for (int axis = 0; axis < 2; ++axis) {
            const double length = scene.bounds.max[axis] - scene.bounds.min[axis];
            sphere.position[axis] -= length * std::floor(sphere.position[axis] / length + 0.5);
        }
    }
    return scene;
}

class Bits : public testing::TestWithParam<scene::Model> {};

// Also of statistics, of the figures that frames carry, and of the places of driven bodies.
void expectTheSameBits(const scene::Scene& scene, double seconds) {
    std::optional<std::uint64_t> expected;
    std::optional<std::vector<glm::vec4>> expectedFigures;
    std::optional<std::vector<double>> expectedPlaces;
    std::optional<std::vector<double>> expectedSums;
    for (const char* const choice : {"software", "cpu:1x1", "cpu:2x4", "cpu:3x8", "cpu:8"}) {
        const auto device = compute::openDevice(choice).value();
        auto simulation = simulate(scene, *device);
        std::uint64_t contacts = 0;
        for (long steps = std::lround(seconds / scene.step); steps > 0; --steps) {
            run(*simulation, scene.step);
            contacts += simulation->statistics().contacts;
        }
        EXPECT_GT(contacts, 0U);
        const std::uint64_t hash = sim::hashOf(simulation->snapshot());
        EXPECT_EQ(hash, expected.value_or(hash)) << choice;
        expected = hash;
        const sim::Statistics now = simulation->statistics();
        const std::vector<double> sums{now.overlapMean, now.elasticEnergy, now.impacts.count, now.impacts.approach};
        EXPECT_EQ(sums, expectedSums.value_or(sums)) << choice;
        expectedSums = sums;
        ASSERT_TRUE(simulation->pipeline().figures());
        const auto figures = simulation->pipeline().read<glm::vec4>(sim::figuresArray, simulation->count());
        EXPECT_EQ(figures, expectedFigures.value_or(figures)) << choice;
        expectedFigures = figures;
        EXPECT_GT(std::ranges::max(figures, {}, &glm::vec4::x).x, 0) << choice;
        std::vector<double> places;
        for (const scene::Obstacle& one : simulation->scene().obstacles)
            if (one.motion && one.motion->drive) places.push_back(one.motion->drive->place);
        EXPECT_EQ(places, expectedPlaces.value_or(places)) << choice;
        expectedPlaces = places;
    }
}

// Returns the simulated time of a case (s).
double seconds(scene::Model model) {
    return model == scene::Model::Accurate ? 0.05 : 0.25;
}

TEST_P(Bits, OfAMixtureAreTheSameOnAllDevices) {
    expectTheSameBits(mixture(GetParam()), seconds(GetParam()));
}

// Also with fixed spheres.
TEST_P(Bits, OfAMixtureInFieldsAreTheSameOnAllDevices) {
    scene::Scene scene = mixture(GetParam());
    scene.forces.fields = {scene::Drag{.density = 100}, scene::Attraction{{0.1, 0.2, -0.3}, 0.5, 0.1}};
    for (std::size_t k = 0; k < scene.spheres.size(); k += 5) {
        scene.spheres[k].fixed = true;
        scene.spheres[k].velocity = scene.spheres[k].spin = glm::vec3(0);
    }
    expectTheSameBits(scene, seconds(GetParam()));
}

// In a hollow box of triangles, above a bumpy ball, a blade and a sheet, all of triangles.
TEST_P(Bits, OfAMixtureAmongMeshesAreTheSameOnAllDevices) {
    scene::Scene scene = mixture(GetParam());
    scene.obstacles.clear();
    scene.obstacles.push_back(
        meshOf(support::boxOf({-0.42, -0.42, -0.38}, {0.42, 0.42, 0.7}), scene::Mesh::Form::Hollow));
    const auto place = [&](const scene::Triangles& triangles, scene::Mesh::Form form, const glm::dvec3& to) {
        scene.obstacles.push_back(
            {.shape = scene::placedShape(scene::meshShape(triangles, form), {{1, 2, 3}, 25}, to), .colour = ""});
    };
    place(support::bumpyBall(0.1, 0.03, 2), scene::Mesh::Form::Solid, {0.2, 0.15, -0.3});
    place(support::boxOf({-0.15, -0.1, -0.01}, {0.15, 0.1, 0.01}), scene::Mesh::Form::Solid, {-0.2, 0.2, -0.25});
    place(support::randomSheet({-0.15, -0.15}, {0.15, 0.15}, 6, 6, 1, 0.05), scene::Mesh::Form::Sheet,
          {-0.1, -0.2, -0.3});
    expectTheSameBits(scene, seconds(GetParam()));
}

// In a turned, hollow box, above obstacles of all shapes, many of which have a frame.
TEST_P(Bits, OfAMixtureAmongObstaclesAreTheSameOnAllDevices) {
    scene::Scene scene = mixture(GetParam());
    scene.obstacles.clear();
    for (const char* const shape :
         {R"("box": {"min": [-0.5, -0.5, -0.4], "max": [0.5, 0.5, 0.6], "hollow": true},
             "rotation": {"axis": [1, 2, 0], "degrees": 4})",
          R"("cone": {"from": [0, 0, 0], "to": [0, 0, 0.2], "fromRadius": 0.15, "toRadius": 0.05},
             "translation": [0.2, 0.1, -0.4])",
          R"("cone": {"from": [-0.25, 0.2, -0.2], "to": [-0.25, 0.2, 0.1], "fromRadius": 0.03, "toRadius": 0.2,
             "open": true})",
          R"("disc": {"centre": [-0.2, -0.25, -0.2], "normal": [1, 0, 3], "radius": 0.2, "hole": 0.05})",
          R"("cylinder": {"from": [0.1, -0.3, -0.3], "to": [0.4, -0.2, -0.2], "radius": 0.1, "open": true})",
          R"("capsule": {"from": [0, -0.1, -0.35], "to": [0.1, 0.2, -0.25], "radius": 0.04})",
          R"("cylinder": {"from": [0, 0.01, -0.35], "to": [0, 0, 0.6], "radius": 0.47, "hollow": true})",
          R"("sphere": {"centre": [0.15, 0.1, -0.3], "radius": 0.1})",
          R"("cylinder": {"from": [-0.3, -0.1, -0.35], "to": [0.2, 0.1, -0.2], "radius": 0.05})"})
        scene.obstacles.push_back(obstacleFrom(std::string("{") + shape + "}"));
    expectTheSameBits(scene, seconds(GetParam()));
}

// In a box that swings, above a roller, a paddle that begins later, and a belt on a plate that shakes. Where the model
// has them, also below a lid that falls, and around a flap.
TEST_P(Bits, OfAMixtureAmongMovingObstaclesAreTheSameOnAllDevices) {
    scene::Scene scene = mixture(GetParam());
    scene.sleep.enabled = true;
    std::vector<std::string> obstacles = {
        R"("box": {"min": [-0.45, -0.45, -0.5], "max": [0.45, 0.45, 0.7], "hollow": true},
           "motion": {"oscillations": [{"swing": [0.02, 0.05, 0], "amplitude": [0.01, 0, 0], "frequency": 3}]})",
        R"("cylinder": {"from": [-0.3, -0.1, -0.3], "to": [0.2, 0.1, -0.2], "radius": 0.07},
           "motion": {"spin": [9, 3, 2]})",
        R"("box": {"min": [-0.2, -0.02, -0.05], "max": [0.2, 0.02, 0.05]}, "translation": [0.1, 0.1, 0],
           "motion": {"spin": [0, 3, 3], "velocity": [0, 0, -0.1], "begin": 0.05})",
        R"("capsule": {"from": [-0.3, 0.2, -0.3], "to": [0.3, 0.2, -0.3], "radius": 0.05},
           "motion": {"belt": [0.5, 0.2, 0], "oscillations": [{"amplitude": [0, 0, 0.005], "frequency": 20}]})"};
    if (GetParam() != scene::Model::Fast) {
        obstacles.push_back(R"("box": {"min": [-0.4, -0.4, 0.36], "max": [0.4, 0.4, 0.4]},
            "motion": {"drive": {"along": [0, 0, 1], "mass": 3, "force": -20, "mostSpeed": 3}})");
        obstacles.push_back(R"("box": {"min": [-0.3, -0.02, -0.3], "max": [0.3, 0.02, -0.1]},
            "motion": {"drive": {"about": [1, 0, 0], "inertia": 0.05, "torque": 2, "mostSpeed": 9}})");
    }
    for (const std::string& obstacle : obstacles) scene.obstacles.push_back(obstacleFrom("{" + obstacle + "}"));
    expectTheSameBits(scene, seconds(GetParam()));
}

TEST_P(Bits, AcrossSeamsAreTheSameOnAllDevices) {
    for (const double ratio : {1.0, 10.0}) expectTheSameBits(periodicMixture(GetParam(), ratio), seconds(GetParam()));
}

TEST_P(Bits, OfSizesOneToTenAreTheSameOnAllDevices) {
    expectTheSameBits(mixedBed(GetParam(), 10), seconds(GetParam()));
}

TEST_P(Bits, OfSizesOneToAHundredAreTheSameOnAllDevices) {
    expectTheSameBits(mixedBed(GetParam(), 100), seconds(GetParam()));
}

// Mesa's software renderer ends the loops of an invocation early. Expects a report of that from it alone. `crowd`: the
// spheres of `scene` in other places.
void expectListsCutShort(const scene::Scene& scene, const scene::Scene& crowd) {
    for (const std::string choice : {"software", "cpu:2x8"}) {
        const auto device = compute::openDevice(choice).value();
        const auto simulation = simulate(scene, *device);
        for (int k = 0; k < 6; ++k) {                 // the lists grow in the first steps
            simulation->upload(sim::stateOf(crowd));  // with the overlaps that a new simulation removes
            ASSERT_TRUE(simulation->step());
        }
        EXPECT_EQ(simulation->counters().cutShort > 0, choice == "software") << simulation->counters().cutShort;
        const std::vector<std::string> notices = simulation->takeNotices();
        EXPECT_EQ(std::ranges::count_if(notices,
                                        [](const std::string& notice) {
                                            return notice.find("cuts its list of pairs short") != std::string::npos;
                                        }),
                  choice == "software" ? 1 : 0);
    }
}

scene::Scene crowdBox(double side) {
    scene::Scene scene = fineStepBox(side);
    scene.quality.model = scene::Model::Balanced;
    return scene;
}

// Twenty large spheres in one place reach 2,000 small ones around them: a group has too many pairs.
TEST(CrowdOnDevices, ThatTheSoftwareRendererCannotListIsReported) {
    scene::Scene scene = crowdBox(4);
    scene::Random random(31);
    constexpr double size = 0.5;
    for (int k = 0; k < 20; ++k) measure::addSphere(scene, {0.01, 0.02, 0.03}, size);
    for (int k = 0; k < 2'000; ++k) {
        const glm::dvec3 n = glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
        measure::addSphere(scene, 1.05 * size * n, 0.02);
    }
    expectListsCutShort(scene, scene);
}

// Clusters of spheres that all touch each other, each in the middle of a group of cells (shared/group.h).
void expectClustersCutShort(int spheresOfCluster) {
    constexpr double cell = 0.1625;  // m
    scene::Scene apart = crowdBox(16 * cell);
    for (int x = 0; x < 21; ++x)
        for (int y = 0; y < 21; ++y)
            for (int z = 0; z < 21; ++z) measure::addSphere(apart, 0.123 * (glm::dvec3(x, y, z) - 10.0), 0.06);
    scene::Scene crowd = apart;
    scene::Random random(31);
    int cluster = 0;
    for (std::size_t k = 0; k < crowd.spheres.size(); ++k) {
        if (k > 0 && k % static_cast<std::size_t>(spheresOfCluster) == 0) ++cluster;
        const glm::dvec3 group(cluster % 8, cluster / 64, cluster / 8 % 8);
        const auto aside = [&] { return random.uniform(-0.03, 0.03); };
        crowd.spheres[k].position = cell * (2.0 * group - 7.0) + glm::dvec3(aside(), aside(), aside());
    }
    expectListsCutShort(apart, crowd);
}

// No group has too many pairs, a block has (shared/bundles.h).
TEST(CrowdOnDevices, ThatTheSoftwareRendererCannotOrderIsReported) {
    for (const int spheresOfCluster : {104, 130}) expectClustersCutShort(spheresOfCluster);
}

// No block has too many pairs, but a bundle has too many that come one by one.
TEST(CrowdOnDevices, ThatTheSoftwareRendererCannotSolveIsReported) {
    for (const int spheresOfCluster : {54, 72}) expectClustersCutShort(spheresOfCluster);
}

INSTANTIATE_TEST_SUITE_P(Of, Bits, testing::Values(scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

INSTANTIATE_TEST_SUITE_P(Of, SceneBits, testing::ValuesIn(scene::names()), [](const auto& parameter) {
    std::string name = parameter.param;
    std::ranges::replace(name, '-', '_');
    return name;
});

}  // namespace
}  // namespace spherule::physics
