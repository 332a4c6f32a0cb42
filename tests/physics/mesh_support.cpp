#include "mesh_support.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <glm/geometric.hpp>

#include "scene/check.h"
#include "scene/random.h"
#include "scene/shapes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::physics {

scene::Obstacle meshOf(scene::Triangles triangles, scene::Mesh::Form form) {
    return {.shape = scene::meshShape(std::move(triangles), form), .colour = ""};
}

scene::Scene spaceFor(scene::Model model, double side) {
    scene::Scene scene = fineStepSpace(side);
    scene.quality = {.model = model, .substeps = model == scene::Model::Accurate ? 50U : 1U};
    return scene;
}

glm::dvec3 placeOf(const sim::State& state, const scene::Scene& scene, std::size_t k) {
    return glm::dvec3(glm::vec3(state.position[k])) + scene.bounds.centre();
}

namespace {

// A body, a shoulder, a neck and a lip.
scene::Obstacle bottle() {
    v1::Obstacle message;
    message.mutable_mesh()->set_data(support::stlOf(support::lathe({{0, -0.9},
                                                                    {0.5, -0.9},
                                                                    {0.55, -0.8},
                                                                    {0.55, 0.1},
                                                                    {0.2, 0.5},
                                                                    {0.16, 0.85},
                                                                    {0.22, 0.9},
                                                                    {0.2, 0.95},
                                                                    {0, 0.95}},
                                                                   40)));
    message.mutable_mesh()->set_hollow(true);
    scene::Check check;
    scene::Obstacle made{.shape = scene::readShape(check, message, "bottle", {.longestSide = 4}), .colour = ""};
    EXPECT_TRUE(check.ok());
    return made;
}

}  // namespace

void flyInBottle(scene::Model model, double seconds, unsigned count, std::uint32_t substeps, double mostChange) {
    constexpr double size = 0.01;  // m
    constexpr double speed = 100;  // m/s
    scene::Scene scene = spaceFor(model, 4);
    setRestitution(scene, 1);
    measure::setFriction(scene, 0);
    scene.sphereContacts = false;
    scene.quality.substeps = substeps;
    scene.obstacles.push_back(bottle());
    scene::Random random(31);
    while (scene.spheres.size() < count) {
        const glm::dvec3 place(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.85, 0.9));
        if (scene.obstacles[0].shape->distance(place) < 2 * size) continue;
        measure::addSphere(scene, place, size,
                           speed * glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal())));
    }
    const auto simulation = simulate(scene);
    const auto energy = [&] {
        const sim::Statistics now = simulation->statistics();
        return now.kineticEnergy + now.elasticEnergy;
    };
    const double before = energy();
    run(*simulation, seconds);
    const sim::State after = simulation->snapshot();
    unsigned outside = 0;
    double deepest = 0;
    double largestChange = 0;  // of the energy of a sphere in free flight
    for (std::size_t k = 0; k < count; ++k) {
        const double distance = scene.obstacles[0].shape->distance(placeOf(after, scene, k));
        if (!(distance > 0)) ++outside;
        deepest = std::max(deepest, (size - distance) / size);
        const glm::dvec3 velocity(glm::vec3(after.velocity[k]));
        if (distance > size)
            largestChange = std::max(largestChange, std::abs(glm::dot(velocity, velocity) / (speed * speed) - 1));
    }
    EXPECT_EQ(outside, 0U);
    EXPECT_NEAR(energy() / before, 1, 0.01);
    EXPECT_LT(largestChange, mostChange);
    testing::Test::RecordProperty("energy", std::to_string(energy() / before - 1));
    testing::Test::RecordProperty("deepest", std::to_string(deepest));
    testing::Test::RecordProperty("largestChange", std::to_string(largestChange));
}

}  // namespace spherule::physics
