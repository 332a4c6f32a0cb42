// Spheres of very different sizes in one scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "mixed.h"
#include "scene/quality.h"
#include "scene/random.h"
#include "support.h"

namespace spherule::physics {
namespace {

// Returns the slots of all pairs that are closer than the margin. It computes with floats, as the kernel does.
std::vector<SlotPair> withinMargin(sim::Simulation& simulation) {
    auto at = simulation.pipeline().read<glm::vec4>(sim::Array::ListReference);
    at.resize(simulation.count());  // the array has room for more spheres
    const auto radii = simulation.pipeline().read<glm::vec4>(sim::Array::Position);
    for (std::size_t slot = 0; slot < at.size(); ++slot) at[slot].w = radii[slot].w;
    const float margin = simulation.plan().grid.margin;
    std::vector<SlotPair> found;
    for (std::uint32_t a = 0; a < at.size(); ++a) {
        for (std::uint32_t b = a + 1; b < at.size(); ++b) {
            const glm::vec3 d = glm::vec3(at[a]) - glm::vec3(at[b]);
            const float reach = at[a].w + at[b].w + margin;
            if (d.x * d.x + d.y * d.y + d.z * d.z < reach * reach) found.emplace_back(a, b);
        }
    }
    return found;
}

// 400 spheres near the surfaces of each other. Some are far outside, where the torus of cells wraps around. Most of
// them move towards another one with the speed `approach` (m/s).
scene::Scene cluster(double side, double ratio, double approach) {
    scene::Scene scene = fineStepSpace(side);
    scene::Random random(7);
    for (int k = 0; k < 400; ++k) {
        scene::Sphere sphere;
        sphere.radius = static_cast<float>(0.5 * std::pow(ratio, -std::sqrt(random.uniform(0, 1))));
        if (k < 2) sphere.radius = static_cast<float>(k == 0 ? 0.5 : 0.5 / ratio);
        glm::dvec3 direction;
        do {
            for (int axis = 0; axis < 3; ++axis) direction[axis] = random.uniform(-1, 1);
        } while (glm::length(direction) > 1 || glm::length(direction) < 0.1);
        direction /= glm::length(direction);
        if (k < 8) {
            sphere.position = direction * random.uniform(0, 3 * side);
        } else {
            const scene::Sphere& host = scene.spheres[static_cast<std::size_t>(random.uniform(0, k))];
            const double apart = static_cast<double>(host.radius + sphere.radius) * random.uniform(0.98, 1.1);
            sphere.position = host.position + direction * apart;
            sphere.velocity = glm::vec3(-approach * direction);
        }
        scene.spheres.push_back(sphere);
    }
    return scene;
}

class Ratio : public testing::TestWithParam<int> {};

TEST_P(Ratio, ContactListsMatchBruteForce) {
    for (const double side : {3.0, 12.0}) {
        const scene::Scene scene = cluster(side, GetParam(), 0);
        const auto simulation = simulate(scene);
        EXPECT_EQ(simulation->plan().grid.sizes() > 1, GetParam() > 2);
        run(*simulation, 2 * scene.step);  // the first step may allocate memory
        ASSERT_EQ(simulation->counters().unlisted, 0U);
        ASSERT_EQ(simulation->counters().sampled, 0U);
        const std::vector<SlotPair> expected = withinMargin(*simulation);
        EXPECT_GT(expected.size(), 300U);
        EXPECT_EQ(listedPairs(*simulation), expected);
    }
}

TEST_P(Ratio, ClusterConservesMomentum) {
    for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate}) {
        SCOPED_TRACE(scene::nameOf(model));
        scene::Scene scene = cluster(12, GetParam(), 0.5);
        scene.quality.model = model;
        if (model == scene::Model::Accurate) scene.quality.substeps = 20;
        scene.materials[0].friction = 0.3;
        const auto simulation = simulate(scene);
        const glm::dvec3 before = momentumOf(simulation->snapshot());
        const double scale = momentumScale(simulation->snapshot());
        std::uint64_t contacts = 0;
        const int steps = model == scene::Model::Accurate ? 5 : 15;
        for (int k = 0; k < steps; ++k) {
            run(*simulation, scene.step);
            contacts += simulation->statistics().contacts;
        }
        EXPECT_GT(contacts, 40U);
        EXPECT_LT(glm::length(momentumOf(simulation->snapshot()) - before), 1e-5 * scale);
        EXPECT_TRUE(allFinite(simulation->snapshot()));
    }
}

INSTANTIATE_TEST_SUITE_P(OneTo, Ratio, testing::Values(2, 10, 30, 100));

TEST(Levels, LargeSphereRestsOnABedOfSmallSpheres) {
    scene::Scene scene = bedUnderOne(1'000, 100);
    const auto simulation = simulate(scene);
    run(*simulation, 1);
    const sim::State state = simulation->snapshot();
    const sim::Statistics statistics = simulation->statistics();
    EXPECT_TRUE(allFinite(state));
    EXPECT_EQ(statistics.outside, 0U);
    const std::uint32_t large = state.count() - 1;
    EXPECT_LT(glm::length(velocityOf(state, large)), 0.05);
    const double gap = positionOf(state, large).z - 0.5 + (scene.bounds.max.z - scene.bounds.min.z) / 2;
    EXPECT_GT(gap, -0.005);
    EXPECT_LT(gap, 0.12);
    EXPECT_LT(statistics.overlapMean, 0.2);
}

// A large sphere rolls into small sleeping ones, and a small sphere into a large sleeping one.
TEST(Levels, SpheresOfOtherSizesWakeSleepingSpheres) {
    scene::Scene scene = sleepyBox(2);
    auto add = [&scene](double x, double y, double radius) {
        scene::Sphere sphere;
        sphere.radius = static_cast<float>(radius);
        sphere.position = {x, y, radius - 1};
        scene.spheres.push_back(sphere);
    };
    for (int k = 0; k < 100; ++k) add(-0.2 + 0.041 * (k % 10), -0.2 + 0.041 * (k / 10), 0.02);
    add(0.65, 0.65, 0.3);
    const std::uint32_t large = 101;
    add(-0.7, 0, 0.25);
    const std::uint32_t small = 102;
    add(0.65, -0.5, 0.02);
    const auto simulation = simulate(scene);
    ASSERT_TRUE(simulation->plan().features.has(sim::Feature::Levels));
    run(*simulation, 3);
    ASSERT_EQ(sleepers(simulation->snapshot()), simulation->count());
    ASSERT_TRUE(simulation->apply(sim::Set{.substeps = 10}));
    EXPECT_EQ(sleepers(simulation->snapshot()), simulation->count()) << "other substeps wake nobody";
    auto push = [&](std::uint32_t id, double x, double y) {
        const double mass = massOf(simulation->snapshot(), id);
        ASSERT_TRUE(simulation->apply(sim::Push{.target = id, .impulse = mass * glm::dvec3(x, y, 0)}));
    };
    push(large, 1, 0);
    push(small, 0, 2);
    std::set<std::uint32_t> woken;
    for (int k = 0; k < 60; ++k) {
        run(*simulation, scene.step);
        const sim::State state = simulation->snapshot();
        for (std::uint32_t id = 0; id < large; ++id)
            if (!asleep(state, id)) woken.insert(id);
    }
    EXPECT_TRUE(woken.contains(100)) << "the large one, hit by a small one";
    EXPECT_GT(woken.size(), 30U) << "small ones, hit by a large one, and those that they hit";
    EXPECT_EQ(simulation->statistics().outside, 0U);
}

}  // namespace
}  // namespace spherule::physics
