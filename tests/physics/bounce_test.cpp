#include <gtest/gtest.h>

#include <cmath>

#include "support.h"

namespace spherule::physics {
namespace {

// Returns the heights (m) of the first `count` apexes of the only sphere, above its height on the floor. Each follows
// from the sphere's energy in the step of the apex.
std::vector<double> apexes(sim::Simulation& simulation, std::size_t count) {
    const scene::Scene& scene = simulation.scene();
    const double g = -scene.forces.gravity.z;
    const double floor = scene.bounds.min.z - scene.bounds.centre().z;
    std::vector<double> found;
    bool rising = false;
    for (int step = 0; step < 600 && found.size() < count; ++step) {
        run(simulation, scene.step);
        const sim::State state = simulation.snapshot();
        const double speed = velocityOf(state, 0).z;
        const double radius = static_cast<double>(state.position[0].w);
        if (rising && speed <= 0) found.push_back(positionOf(state, 0).z - floor - radius + speed * speed / (2 * g));
        rising = speed > 0;
    }
    return found;
}

TEST(Bounce, FiveApexesAreWithinOnePercent) {
    const auto simulation = simulate(named("bounce"));
    const std::vector<double> found = apexes(*simulation, 5);
    ASSERT_EQ(found.size(), 5U);
    double expected = 1;
    for (std::size_t k = 0; k < found.size(); ++k) {
        expected *= 0.8 * 0.8;
        EXPECT_NEAR(found[k], expected, 0.01 * expected) << "apex " << k + 1;
        RecordProperty("apex" + std::to_string(k + 1), std::to_string(found[k]));
    }
}

TEST(Bounce, ElasticSphereReturnsToItsInitialHeight) {
    scene::Scene scene = named("bounce");
    setRestitution(scene, 1);
    const auto simulation = simulate(scene);
    const std::vector<double> found = apexes(*simulation, 5);
    ASSERT_EQ(found.size(), 5U);
    for (const double height : found) EXPECT_NEAR(height, 1, 0.01);
}

}  // namespace
}  // namespace spherule::physics
