// The kernels compiled with double in place of float.
#include <gtest/gtest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "support.h"

namespace spherule::physics {
namespace {

// Returns the error (m) of the position of a sphere that moves freely for 20 s. The host passes floats to the kernels;
// this step length is exact as a float.
double errorOfAGlide(const std::string& choice) {
    scene::Scene scene = fineStepSpace(100);
    scene.sphereContacts = false;
    scene.step = 1.0 / 512;
    scene::Sphere sphere;
    sphere.radius = 0.5F;
    sphere.position = {-20, 10, 0};
    sphere.velocity = {1.37F, -0.71F, 0.013F};
    scene.spheres = {sphere};
    const auto device = compute::openDevice(choice).value();
    const auto simulation = simulate(scene, *device);
    run(*simulation, 20);
    const glm::dvec3 wanted = sphere.position + 20.0 * glm::dvec3(sphere.velocity);
    return glm::length(positionOf(simulation->snapshot(), 0) - wanted);
}

// Floats lose up to half a unit in the last place in each of 10,240 substeps. With doubles, only the result is rounded.
TEST(Double, RoundsOnlyTheResult) {
    const double rounding = 32.0 / (1 << 24);  // of floats below 32, in three components
    EXPECT_LT(errorOfAGlide("cpu-double"), rounding);
    EXPECT_GT(errorOfAGlide("cpu"), 20 * rounding) << "the test cannot tell the two apart";
}

TEST(Double, IsDeterministicForAnyNumberOfThreads) {
    std::uint64_t first = 0;
    for (const char* const choice : {"cpu-double:1", "cpu-double:3"}) {
        const auto device = compute::openDevice(choice).value();
        const auto simulation = simulate(named("pour"), *device);
        run(*simulation, 0.3);
        EXPECT_TRUE(allFinite(simulation->snapshot()));
        const std::uint64_t hash = sim::hashOf(simulation->snapshot());
        if (first == 0) first = hash;
        EXPECT_EQ(hash, first) << choice;
    }
}

}  // namespace
}  // namespace spherule::physics
