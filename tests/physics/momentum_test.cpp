#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "scene/random.h"
#include "support.h"

namespace spherule::physics {
namespace {

// A cloud of 1,000 spheres on a jittered lattice that contracts. Each sphere moves towards the middle at 2 m/s per m of
// distance, plus a random velocity of up to 0.5 m/s along each axis.
scene::Scene contractingCloud(bool equal) {
    scene::Scene scene = fineStepSpace(10);
    scene::Random random(7);
    constexpr int kinds = 50;
    for (int k = 1; k < kinds; ++k) addMaterial(scene, {.density = random.uniform(500, 8000)});
    for (int k = 0; k < 1000; ++k) {
        scene::Sphere sphere;
        sphere.radius = equal ? 0.05F : static_cast<float>(random.uniform(0.02, 0.055));
        sphere.material = equal ? std::uint8_t{0} : static_cast<std::uint8_t>(k % kinds);
        glm::dvec3 own;
        for (int axis = 0; axis < 3; ++axis) {
            const int place = axis == 0 ? k % 10 : axis == 1 ? k / 10 % 10 : k / 100;
            sphere.position[axis] = 0.13 * (place - 4.5) + random.uniform(-0.008, 0.008);
            own[axis] = random.uniform(-0.5, 0.5);
        }
        sphere.velocity = glm::vec3(own - 2.0 * sphere.position + glm::dvec3(0.3, -0.2, 0.1));
        scene.spheres.push_back(sphere);
    }
    setRestitution(scene, 0.7);
    return scene;
}

class Momentum : public testing::TestWithParam<bool> {};

TEST_P(Momentum, IsConservedInThousandsOfCollisions) {
    const auto simulation = simulate(contractingCloud(GetParam()));
    const sim::State before = simulation->snapshot();
    std::uint64_t contacts = 0;
    for (int k = 0; k < 1000; ++k) {
        run(*simulation, simulation->scene().step);
        contacts += touchingPairs(*simulation);
    }
    const sim::State after = simulation->snapshot();
    ASSERT_TRUE(allFinite(after));
    EXPECT_GT(contacts, 2000U) << "too few collisions to say anything";
    const double drift = glm::length(momentumOf(after) - momentumOf(before)) / momentumScale(before);
    EXPECT_LT(drift, 1e-5);
    EXPECT_LT(kineticEnergyOf(after), kineticEnergyOf(before)) << "collisions take energy";
    RecordProperty("drift", std::to_string(drift * 1e9) + "e-9");
    RecordProperty("contacts", std::to_string(contacts));
}

INSTANTIATE_TEST_SUITE_P(OfUnequalAndEqualSpheres, Momentum, testing::Bool());

}  // namespace
}  // namespace spherule::physics
