#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "scene/shapes.h"
#include "support.h"

// The measured restitution differs from the requested one by at most 0.01, for all kinds of pairs.
namespace spherule::physics {
namespace {

constexpr double tolerance = 0.01;

class Restitution : public testing::TestWithParam<double> {};

struct Meeting {
    const char* name;
    scene::Sphere a;
    scene::Sphere b;
};

// Collisions along x, each in its own lane. The last figure is the material, of 1,000, 20,000, 7,800 or 500 kg/m^3.
const std::vector<Meeting> meetings{
    {"equal", {{-0.3, 0, 0}, {1, 0, 0}, 0.05F}, {{0.3, 0, 0}, {-1, 0, 0}, 0.05F}},
    {"one at rest", {{-0.3, 0, 0}, {2, 0, 0}, 0.05F}, {{0, 0, 0}, {}, 0.05F}},
    {"slow", {{-0.06, 0, 0}, {0.05F, 0, 0}, 0.05F}, {{0.05, 0, 0}, {}, 0.05F}},
    {"unequal masses", {{-0.3, 0, 0}, {1, 0, 0}, 0.05F, 1}, {{0.3, 0, 0}, {-1, 0, 0}, 0.05F}},
    {"unequal radii", {{-0.3, 0, 0}, {1, 0, 0}, 0.09F}, {{0.3, 0, 0}, {-1, 0, 0}, 0.03F}},
    {"oblique", {{-0.3, 0.03, 0.02}, {1.2F, 0, 0}, 0.05F}, {{0.3, 0, 0}, {-1, 0.05F, 0}, 0.05F}},
    {"oblique, all unequal", {{-0.3, 0.04, -0.01}, {0.7F, 0, 0}, 0.04F, 2}, {{0.3, 0, 0}, {-1.1F, 0, 0.02F}, 0.08F, 3}},
};

scene::Scene lanes(double restitution) {
    scene::Scene scene = fineStepSpace(8);
    for (const double density : {20000.0, 7800.0, 500.0}) addMaterial(scene, {.density = density});
    double lane = -2;
    for (const Meeting& meeting : meetings) {
        for (scene::Sphere sphere : {meeting.a, meeting.b}) {
            sphere.position.y += lane;
            scene.spheres.push_back(sphere);
        }
        lane += 0.5;
    }
    setRestitution(scene, restitution);
    return scene;
}

// Returns separation speed / approach speed, along the direction of the impulse.
double measured(const sim::State& before, const sim::State& after, std::uint32_t a, std::uint32_t b) {
    const glm::dvec3 change = velocityOf(after, a) - velocityOf(before, a);
    EXPECT_GT(glm::length(change), 1e-3) << "they never met";
    const glm::dvec3 n = glm::normalize(change);
    return -glm::dot(velocityOf(after, a) - velocityOf(after, b), n) /
           glm::dot(velocityOf(before, a) - velocityOf(before, b), n);
}

TEST_P(Restitution, MatchesTheSceneForEveryKindOfPair) {
    const auto simulation = simulate(lanes(GetParam()));
    const sim::State before = simulation->snapshot();
    run(*simulation, 0.5);
    const sim::State after = simulation->snapshot();
    double worst = 0;
    for (std::uint32_t k = 0; k < meetings.size(); ++k) {
        SCOPED_TRACE(meetings[k].name);
        const double got = measured(before, after, 2 * k, 2 * k + 1);
        EXPECT_NEAR(got, GetParam(), tolerance);
        worst = std::max(worst, std::abs(got - GetParam()));
        const glm::dvec3 drift =
            massOf(before, 2 * k) * (velocityOf(after, 2 * k) - velocityOf(before, 2 * k)) +
            massOf(before, 2 * k + 1) * (velocityOf(after, 2 * k + 1) - velocityOf(before, 2 * k + 1));
        EXPECT_LT(glm::length(drift), 1e-5 * massOf(before, 2 * k) * glm::length(velocityOf(before, 2 * k)));
    }
    RecordProperty("worst", std::to_string(worst));
}

TEST_P(Restitution, MatchesTheSceneForIdenticalSpheres) {
    scene::Scene scene = named("two-spheres");
    setRestitution(scene, GetParam());
    const auto simulation = simulate(scene);
    const sim::State before = simulation->snapshot();
    run(*simulation, 0.6);
    EXPECT_NEAR(measured(before, simulation->snapshot(), 0, 1), GetParam(), tolerance);
}

TEST_P(Restitution, MatchesTheSceneAtWallsPlanesAndBoxes) {
    scene::Scene scene = fineStepSpace(4);
    scene.bounds.open[scene::ZMin] = false;
    const glm::dvec3 slope = glm::normalize(glm::dvec3(1, 0, 2));
    scene.obstacles.push_back({scene::planeShape({-1.5, 0, -1.2}, slope), 0, ""});
    scene.obstacles.push_back({scene::boxShape({{1, -0.5, -1.6}, {1.4, 0.5, -1.2}}), 0, ""});
    scene.spheres = {{{0.2, 0, -1.6}, {0.5F, 0.3F, -2}, 0.05F},
                     {{-1.5, 0, -0.8}, {0, 0.3F, -2}, 0.07F},
                     {{1.2, 0, -0.8}, {0.1F, 0, -2}, 0.05F}};
    setRestitution(scene, GetParam());
    const auto simulation = simulate(scene);
    const sim::State before = simulation->snapshot();
    run(*simulation, 0.4);
    const sim::State after = simulation->snapshot();
    const glm::dvec3 normals[] = {{0, 0, 1}, slope, {0, 0, 1}};
    for (std::uint32_t id = 0; id < 3; ++id) {
        SCOPED_TRACE(id);
        const glm::dvec3 in = velocityOf(before, id);
        const glm::dvec3 out = velocityOf(after, id);
        EXPECT_NEAR(-glm::dot(out, normals[id]) / glm::dot(in, normals[id]), GetParam(), tolerance);
        const glm::dvec3 change = out - in;
        EXPECT_LT(glm::length(change - glm::dot(change, normals[id]) * normals[id]), 1e-5) << "there is no friction";
    }
}

INSTANTIATE_TEST_SUITE_P(Of, Restitution, testing::Values(0.0, 0.5, 0.9, 1.0));

TEST(Restitution, IsTheSmallerOneOfTwoMaterials) {
    scene::Scene scene = lanes(0.9);
    // The new material keeps the density of the one that it replaces.
    for (std::size_t k = 0; k < scene.spheres.size(); k += 2) {
        scene::Sphere& sphere = scene.spheres[k + (k / 2) % 2];
        sphere.material = addMaterial(scene, {.density = scene.materials[sphere.material].density, .restitution = 0.3});
    }
    const auto simulation = simulate(scene);
    const sim::State before = simulation->snapshot();
    run(*simulation, 0.5);
    const sim::State after = simulation->snapshot();
    for (std::uint32_t k = 0; k < meetings.size(); ++k) {
        SCOPED_TRACE(meetings[k].name);
        EXPECT_NEAR(measured(before, after, 2 * k, 2 * k + 1), 0.3, tolerance);
    }
}

}  // namespace
}  // namespace spherule::physics
