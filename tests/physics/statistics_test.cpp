#include <gtest/gtest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "scene/random.h"
#include "support.h"

namespace spherule::physics {
namespace {

// 600 spheres of two kinds after a fall of 0.5 s, so that the spheres move and touch.
std::unique_ptr<sim::Simulation> fallenHeap() {
    scene::Scene scene = fineStepBox(1.2);
    scene.bounds.open[scene::ZMax] = true;
    scene::Random random(2);
    const std::uint8_t heavy = addMaterial(scene, {.density = 3000});
    for (int k = 0; k < 600; ++k) {
        scene::Sphere sphere;
        sphere.radius = k % 3 == 0 ? 0.03F : 0.05F;
        sphere.material = k % 2 == 0 ? 0 : heavy;
        const glm::dvec3 place{k % 10, k / 10 % 10, k / 100};
        sphere.position = 0.11 * (place - glm::dvec3(4.5, 4.5, 4.5));
        sphere.position.x += random.uniform(-0.004, 0.004);
        scene.spheres.push_back(sphere);
    }
    scene.spheres.back().velocity = {0, 0, 8};  // leaves through the open top
    setRestitution(scene, 0.3);
    auto simulation = simulate(scene);
    run(*simulation, 0.5);
    return simulation;
}

struct Sums {
    double kinetic = 0;
    double potential = 0;
    double height = 0;
    double squares = 0;
    double fastest = 0;
    double deepest = 0;
    std::uint32_t outside = 0;
    double contacts = 0;
    double overlaps = 0;
    double largest = 0;
};

void addOverlapsOf(Sums& sums, const reference::World& world, std::size_t i) {
    const reference::Sphere& a = world.spheres[i];
    for (std::size_t j = i + 1; j < world.spheres.size(); ++j) {
        const reference::Sphere& b = world.spheres[j];
        const double overlap = (a.radius + b.radius - glm::length(a.x - b.x)) / std::min(a.radius, b.radius);
        if (overlap <= 0) continue;
        ++sums.contacts;
        sums.overlaps += overlap;
        sums.largest = std::max(sums.largest, overlap);
    }
}

Sums sumsOf(const reference::World& world) {
    Sums sums;
    const auto count = static_cast<double>(world.spheres.size());
    for (std::size_t i = 0; i < world.spheres.size(); ++i) {
        const reference::Sphere& a = world.spheres[i];
        const double height = a.x.z + 0.6;
        sums.height += height / count;
        sums.kinetic += glm::dot(a.v, a.v) / 2 / a.inverseMass;
        sums.potential += earth * height / a.inverseMass;
        sums.squares += glm::dot(a.v, a.v) / count;
        sums.fastest = std::max(sums.fastest, glm::length(a.v));
        for (const reference::Wall& wall : world.walls)
            sums.deepest = std::max(sums.deepest, depthIn(wall, a) / a.radius);
        if (a.x.z > 0.6) ++sums.outside;
        addOverlapsOf(sums, world, i);
    }
    return sums;
}

TEST(Statistics, MatchSumsOverTheState) {
    const auto simulation = fallenHeap();
    const sim::Statistics got = simulation->statistics();
    const sim::State state = simulation->snapshot();
    const Sums expected = sumsOf(referenceOf(simulation->scene(), state));
    constexpr double share = 1e-5;
    EXPECT_NEAR(got.kineticEnergy, expected.kinetic, share * expected.kinetic);
    EXPECT_NEAR(got.potentialEnergy, expected.potential, share * expected.potential);
    EXPECT_EQ(got.rotationalEnergy, 0);
    EXPECT_LT(glm::length(got.momentum - momentumOf(state)), share * momentumScale(state));
    EXPECT_NEAR(got.meanHeight, expected.height, share);
    EXPECT_NEAR(got.speedRms, std::sqrt(expected.squares), share);
    EXPECT_NEAR(got.speedMax, expected.fastest, share * expected.fastest);
    EXPECT_NEAR(got.wallOverlapMax, std::max(expected.deepest, 0.0), share);
    EXPECT_EQ(expected.outside, 1U) << "the test throws one out";
    EXPECT_EQ(got.outside, expected.outside);
    EXPECT_GT(expected.contacts, 200);
    // The rounding of float32 decides whether pairs that just touch overlap.
    EXPECT_NEAR(static_cast<double>(got.contacts), expected.contacts, 0.05 * expected.contacts);
    EXPECT_NEAR(got.overlapMean * static_cast<double>(got.contacts), expected.overlaps, 1e-3 * expected.overlaps);
    EXPECT_NEAR(got.overlapMax, expected.largest, share);
}

}  // namespace
}  // namespace spherule::physics
