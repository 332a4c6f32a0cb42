#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "scene/random.h"
#include "scene/shapes.h"
#include "support.h"

namespace spherule::physics {
namespace {

// The depth of the sphere in each wall and obstacle (m), beyond the gap up to which it touches.
std::vector<double> depthsOf(const scene::Scene& scene, const glm::dvec3& x, double radius) {
    std::vector<double> depths;
    for (unsigned face = 0; face < 6; ++face) {
        const int axis = static_cast<int>(face / 2);
        if (scene.bounds.open[face]) continue;
        depths.push_back(radius -
                         (face % 2 == 0 ? x[axis] - scene.bounds.min[axis] : scene.bounds.max[axis] - x[axis]));
    }
    for (const scene::Obstacle& obstacle : scene.obstacles) depths.push_back(radius - obstacle.shape->distance(x));
    for (double& depth : depths) depth += 2e-4 * radius;
    return depths;
}

// Counts in double. Returns -1 for a sphere with a gap or an overlap that rounding may decide.
std::vector<int> countsOf(const scene::Scene& scene, const sim::State& state) {
    constexpr double rounding = 1e-6;  // m
    std::vector<int> counts(state.count(), 0);
    const auto add = [&](std::uint32_t id, double depth) {
        int& count = counts[id];
        if (count < 0 || std::abs(depth) < rounding)
            count = -1;
        else if (depth > 0)
            ++count;
    };
    for (std::uint32_t a = 0; a < state.count(); ++a) {
        if (!scene.spheres[a].fixed)
            for (const double depth : depthsOf(scene, positionOf(state, a), radiusOf(state, a))) add(a, depth);
        for (std::uint32_t b = 0; b < a; ++b) {
            if (scene.spheres[a].fixed && scene.spheres[b].fixed) continue;
            const double reach = (radiusOf(state, a) + radiusOf(state, b)) * (1 + 1e-4);
            const double depth = reach - glm::distance(positionOf(state, a), positionOf(state, b));
            add(a, depth);
            add(b, depth);
        }
    }
    return counts;
}

class ContactCounts : public testing::TestWithParam<scene::Model> {};

TEST_P(ContactCounts, AreThoseOfAllPairsAndSurfaces) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        scene::Scene scene = fineStepBox(0.8);
        scene.bounds.open[scene::ZMax] = true;
        scene.obstacles = {{scene::planeShape({-0.3, 0, 0}, {std::sqrt(0.5), 0, std::sqrt(0.5)}), 0, ""},
                           {scene::boxShape({{0.1, 0.1, -0.4}, {0.3, 0.3, -0.2}}), 0, ""}};
        scene::Random random(seed);
        for (int k = 0; k < 400; ++k) {
            const glm::dvec3 place(random.uniform(-0.2, 0.35), random.uniform(-0.35, 0.35), random.uniform(-0.1, 0.4));
            measure::addSphere(scene, place, random.uniform(0.02, 0.05)).fixed = k % 10 == 0;
        }
        scene.quality.model = GetParam();
        scene.quality.substepsFixed = false;
        ASSERT_TRUE(scene::fitSubsteps(scene));
        auto simulation = simulate(scene);
        run(*simulation, GetParam() == scene::Model::Accurate ? 0.05 : 0.3);
        const std::vector<std::uint32_t> counts = simulation->contactCounts();
        const sim::State state = simulation->snapshot();
        const std::vector<int> expected = countsOf(simulation->scene(), state);
        int sure = 0;
        std::uint64_t touching = 0;
        for (std::uint32_t id = 0; id < state.count(); ++id) {
            if (expected[id] < 0) continue;
            ++sure;
            touching += counts[id];
            EXPECT_EQ(counts[id], static_cast<std::uint32_t>(expected[id])) << id;
        }
        EXPECT_GT(sure, 300);
        EXPECT_GT(touching, 100U);
    }
}

INSTANTIATE_TEST_SUITE_P(Of, ContactCounts,
                         testing::Values(scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

// Without contacts between spheres, walls alone count.
TEST(ContactCounts, OfDustAreWalls) {
    scene::Scene scene = fineStepBox(1);
    scene.sphereContacts = false;
    measure::addSphere(scene, {0, 0, -0.45}, 0.05);
    measure::addSphere(scene, {0, 0.01, -0.46}, 0.05);
    measure::addSphere(scene, {0.46, 0.46, 0}, 0.05);
    measure::addSphere(scene, {0.3, 0.3, 0}, 0.05);
    EXPECT_EQ(simulate(scene)->contactCounts(), (std::vector<std::uint32_t>{1, 1, 2, 0}));
}

}  // namespace
}  // namespace spherule::physics
