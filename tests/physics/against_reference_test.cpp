#include <gtest/gtest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "scene/random.h"
#include "scene/shapes.h"
#include "support.h"

// Compares isolated contacts on the device with the reference, over 0.5 s. In this time, float32 rounds a position 240
// times, each time by up to 2^-24 of its distance from the centre. At constant velocity, all roundings have the same
// direction. To keep the error of roundings below the error of contacts, spheres of 0.5 m stay within 2 m of the
// centre, and weak oblique gravity makes the roundings differ.
namespace spherule::physics {
namespace {

constexpr double tolerance = 1e-5;  // of the radius
constexpr double seconds = 0.5;
constexpr float largestRadius = 0.55F;
const glm::dvec3 weakGravity{0.4, -0.5, -0.7};

glm::dvec3 somewhere(scene::Random& random, double reach) {
    const double x = random.uniform(-reach, reach);
    const double y = random.uniform(-reach, reach);
    return {x, y, random.uniform(-reach, reach)};
}

// Places two spheres of unequal radius and mass that are about to collide, at a random angle.
void placePair(scene::Random& random, scene::Scene& scene, scene::Sphere& a, scene::Sphere& b) {
    a.radius = static_cast<float>(random.uniform(0.35, 0.55));
    b.radius = static_cast<float>(random.uniform(0.35, 0.55));
    a.material = addMaterial(scene, {.density = random.uniform(500, 2000)});
    const glm::dvec3 line = glm::normalize(somewhere(random, 1));
    const glm::dvec3 aside = 0.4 * somewhere(random, 1);
    const glm::dvec3 side = aside - glm::dot(aside, line) * line;
    a.position = 0.5 * side - line * (static_cast<double>(a.radius) + 0.02);
    b.position = -0.5 * side + line * (static_cast<double>(b.radius) + 0.02);
    a.velocity = glm::vec3(line * random.uniform(0.3, 0.6));
    b.velocity = glm::vec3(-line * random.uniform(0.1, 0.6) + 0.1 * somewhere(random, 1));
}

struct Difference {
    double ofRadius = 0;
    double turned = 0;  // smallest change of a velocity by contacts, m/s
};

// Runs the simulation and the reference; returns their largest difference.
Difference difference(sim::Simulation& simulation) {
    const sim::State start = simulation.snapshot();
    reference::World world = referenceOf(simulation);
    for (int k = 0; k < std::lround(seconds / simulation.scene().step); ++k) world.substep(simulation.scene().step);
    run(simulation, seconds);
    const sim::State end = simulation.snapshot();
    Difference worst{0, 1e30};
    for (std::uint32_t id = 0; id < end.count(); ++id) {
        const reference::Sphere& expected = world.spheres[id];
        worst.ofRadius = std::max(worst.ofRadius, glm::length(positionOf(end, id) - expected.x) / expected.radius);
        const glm::dvec3 change = expected.v - velocityOf(start, id) - seconds * simulation.scene().forces.gravity;
        worst.turned = std::min(worst.turned, glm::length(change));
    }
    return worst;
}

// One simulation runs the pairs one after another.
TEST(AgainstReference, FortyIsolatedPairsAgree) {
    scene::Scene scene = fineStepSpace(5);
    scene.forces.gravity = weakGravity;
    scene.spheres.resize(2);
    scene.spheres[0].radius = 0.4F;
    scene.spheres[1].radius = largestRadius;
    setRestitution(scene, 0.7);
    const auto simulation = simulate(scene);
    scene::Random random(3);
    double worst = 0;
    for (int k = 0; k < 40; ++k) {
        SCOPED_TRACE(k);
        placePair(random, scene, scene.spheres[0], scene.spheres[1]);
        simulation->upload(sim::stateOf(scene));
        const Difference found = difference(*simulation);
        EXPECT_LT(found.ofRadius, tolerance);
        EXPECT_GT(found.turned, 0.01) << "they never met";
        worst = std::max(worst, found.ofRadius);
    }
    RecordProperty("worstInRadii", std::to_string(worst * 1e9) + "e-9");
}

// The spheres do not touch each other. Each hits one or two of five walls and a slope.
TEST(AgainstReference, FortySpheresAtWallsAgree) {
    scene::Scene scene = fineStepSpace(1.6);
    scene.forces.gravity = weakGravity;
    scene.sphereContacts = false;
    scene.bounds.open.fill(false);
    scene.bounds.open[scene::ZMax] = true;
    scene.obstacles.push_back({scene::planeShape({-0.5, 0, -0.5}, glm::normalize(glm::dvec3(1, 0.3, 1))), 0, ""});
    scene::Random random(5);
    for (int k = 0; k < 40; ++k) {
        scene::Sphere sphere;
        sphere.radius = static_cast<float>(random.uniform(0.35, 0.55));
        const glm::dvec3 aim = glm::normalize(somewhere(random, 1) - glm::dvec3(0, 0, 0.8));
        sphere.position = aim * 0.05;
        sphere.velocity = glm::vec3(aim * random.uniform(1.2, 2));
        scene.spheres.push_back(sphere);
    }
    setRestitution(scene, 0.7);
    const auto simulation = simulate(scene);
    const Difference found = difference(*simulation);
    EXPECT_LT(found.ofRadius, tolerance);
    EXPECT_GT(found.turned, 0.1) << "one never met a wall";
    RecordProperty("worstInRadii", std::to_string(found.ofRadius * 1e9) + "e-9");
}

}  // namespace
}  // namespace spherule::physics
