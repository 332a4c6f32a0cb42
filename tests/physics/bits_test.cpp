// Every shipped scene gives the same bits on the CPU with any number of threads. A few scenes have the same bits on
// Mesa's software renderer, which takes seconds to compile the kernels of a scene. SPHERULE_BITS_SECONDS sets the
// simulated time (s), and then all scenes run on that renderer. The default is 0.3 s, 0.1 s with more than 10,000
// spheres, and one step with more than 100,000. The long tests bits_long* run longer.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "mixtures.h"
#include "scene/quality.h"
#include "scene/random.h"
#include "support.h"

namespace spherule::physics {
namespace {

class SceneBits : public testing::TestWithParam<std::string> {};

// Together they have all features of the shipped scenes.
constexpr std::array inSoftware{"avalanche", "billiards", "box-4k", "brazil-nut", "cradle",
                                "fountain",  "piston",    "rapids", "snow-globe"};

bool longRun() {
    return std::getenv("SPHERULE_BITS_SECONDS") != nullptr;
}

// Returns the simulated time of a scene (s).
double durationOf(const scene::Scene& scene) {
    if (longRun()) return std::stod(std::getenv("SPHERULE_BITS_SECONDS"));
    if (scene.spheres.size() > 100'000) return scene.step;
    return scene.spheres.size() > 10'000 ? 0.1 : 0.3;
}

TEST_P(SceneBits, AreTheSameOnAllDevices) {
    const scene::Scene scene = named(GetParam());
    std::vector<const char*> devices{"cpu:1x1", "cpu:2x4", "cpu:3x8", "cpu:8"};
    if (longRun() || std::ranges::find(inSoftware, GetParam()) != inSoftware.end()) devices.push_back("software");
    std::optional<std::uint64_t> expected;
    for (const char* const choice : devices) {
        const auto device = compute::openDevice(choice).value();
        auto simulation = simulate(scene, *device);
        run(*simulation, durationOf(scene));
        const std::uint64_t hash = sim::hashOf(simulation->snapshot());
        EXPECT_EQ(hash, expected.value_or(hash)) << choice;
        expected = hash;
    }
}

TEST(ScenesInSoftware, HaveAllFeaturesOfTheOthers) {
    sim::Features had;
    for (const char* const name : inSoftware) {
        const sim::Features features = sim::featuresOf(named(name));
        for (const sim::Feature feature : sim::allFeatures())
            had.set(feature, had.has(feature) || features.has(feature));
    }
    for (const std::string& name : scene::names()) EXPECT_TRUE(had.hasAll(sim::featuresOf(named(name)))) << name;
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

TEST(BitsOfMovers, AreTheSameOnAllDevices) {
    for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced}) {
        const scene::Scene scene = layerUnderRain(model);
        expectTheSameBits(scene, 0.4);
        auto simulation = simulate(scene);
        run(*simulation, 0.4);
        EXPECT_GT(simulation->pipeline().read<std::uint32_t>(sim::Array::Counters)[COUNTER_MOVERS], 0U);
    }
}

TEST_P(Bits, OfAMixtureInFieldsAreTheSameOnAllDevices) {
    expectTheSameBits(mixtureInFields(GetParam()), seconds(GetParam()));
}

TEST_P(Bits, OfAMixtureInMediaAreTheSameOnAllDevices) {
    expectTheSameBits(mixtureInMedia(GetParam()), seconds(GetParam()));
}

TEST_P(Bits, OfAMixtureAmongMeshesAreTheSameOnAllDevices) {
    expectTheSameBits(mixtureAmongMeshes(GetParam()), seconds(GetParam()));
}

TEST_P(Bits, OfAMixtureAmongObstaclesAreTheSameOnAllDevices) {
    expectTheSameBits(mixtureAmongObstacles(GetParam()), seconds(GetParam()));
}

TEST_P(Bits, OfAMixtureAmongMovingObstaclesAreTheSameOnAllDevices) {
    expectTheSameBits(mixtureAmongMovingObstacles(GetParam()), seconds(GetParam()));
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

// Twenty large spheres in one place reach 2,000 small ones around them. One thread alone would have too many pairs for
// the software renderer. The threads of a work group share them.
TEST(CrowdOnDevices, OfLargeSpheresAmongSmallOnesIsListedAlike) {
    scene::Scene scene = crowdBox(4);
    scene::Random random(31);
    constexpr double size = 0.5;
    for (int k = 0; k < 20; ++k) measure::addSphere(scene, {0.01, 0.02, 0.03}, size);
    for (int k = 0; k < 2'000; ++k) {
        const glm::dvec3 n = glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
        measure::addSphere(scene, 1.05 * size * n, 0.02);
    }
    std::vector<std::uint64_t> hashes;
    for (const std::string choice : {"software", "cpu:2x8"}) {
        const auto device = compute::openDevice(choice).value();
        const auto simulation = simulate(scene, *device);
        for (int k = 0; k < 2; ++k) {                 // the lists grow in the first step
            simulation->upload(sim::stateOf(scene));  // with the overlaps that a new simulation removes
            ASSERT_TRUE(simulation->step());
        }
        EXPECT_EQ(simulation->counters().cutShort, 0U) << choice;
        hashes.push_back(sim::hashOf(simulation->snapshot()));
    }
    EXPECT_EQ(hashes[0], hashes[1]);
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
