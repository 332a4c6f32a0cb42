#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "scene/quality.h"
#include "support.h"

namespace spherule::physics {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// A cube of spheres that touch their neighbours.
scene::Scene block(int perSide) {
    scene::Scene scene = fineStepBox(1);
    for (int k = 0; k < perSide * perSide * perSide; ++k) {
        scene::Sphere sphere;
        sphere.radius = 0.05F;
        const glm::dvec3 place{k % perSide, k / perSide % perSide, k / perSide / perSide};
        sphere.position = 0.0999 * place - glm::dvec3(0.4, 0.4, 0.45);
        scene.spheres.push_back(sphere);
    }
    return scene;
}

class NonFinite : public testing::TestWithParam<glm::vec4> {};

TEST_P(NonFinite, SphereIsCountedAndDoesNotAffectOthers) {
    constexpr std::uint32_t id = 62;  // in the middle of 5 x 5 x 5
    const auto simulation = simulate(block(5));
    run(*simulation, 0.1);
    ASSERT_FALSE(simulation->counters().nonFinite);
    sim::Pipeline& pipeline = simulation->pipeline();
    const std::uint32_t slot = pipeline.read<std::uint32_t>(sim::Array::SlotOf).at(id);
    const glm::vec4 bad = GetParam();
    pipeline.write<glm::vec4>(sim::Array::Velocity, std::span(&bad, 1), slot);
    run(*simulation, simulation->scene().step);
    EXPECT_TRUE(simulation->counters().nonFinite);
    EXPECT_EQ(simulation->counters().firstNonFinite, id);
    run(*simulation, 0.5);
    EXPECT_TRUE(simulation->counters().nonFinite);
    const sim::Statistics statistics = simulation->statistics();
    EXPECT_EQ(statistics.nonFinite, 1U);
    EXPECT_LT(statistics.speedMax, 10);
    EXPECT_EQ(statistics.outside, 0U);
    sim::State state = simulation->snapshot();
    state.position.erase(state.position.begin() + id);
    state.velocity.erase(state.velocity.begin() + id);
    EXPECT_TRUE(allFinite(state));
}

class Divergence : public testing::TestWithParam<scene::Model> {};

TEST_P(Divergence, IsReportedAndRolledBackToTheLastFiniteState) {
    scene::Scene scene = block(4);
    scene.step = 1.0 / 60;
    scene.quality = {.model = GetParam(), .substeps = 8, .substepsFixed = true};
    scene.materials[0].friction = 0.3;
    scene.sleep.enabled = true;
    const auto simulation = simulate(scene);
    run(*simulation, 1.5);
    const glm::vec4 bad(nan, 0, 0, 1);
    sim::Pipeline& pipeline = simulation->pipeline();
    const std::uint32_t slot = pipeline.read<std::uint32_t>(sim::Array::SlotOf).at(7);
    pipeline.write<glm::vec4>(sim::Array::Velocity, std::span(&bad, 1), slot);
    run(*simulation, simulation->scene().step);
    ASSERT_TRUE(simulation->counters().nonFinite);
    EXPECT_NE(simulation->divergence().find("sphere 7 has no finite position any more at step 91; at step 60"),
              std::string::npos)
        << simulation->divergence();
    simulation->rollback();
    EXPECT_EQ(simulation->steps(), 60U);
    EXPECT_EQ(simulation->time(), 60 * scene.step);
    EXPECT_TRUE(allFinite(simulation->snapshot()));
    run(*simulation, 0.5);
    EXPECT_FALSE(simulation->counters().nonFinite);
    EXPECT_TRUE(allFinite(simulation->snapshot()));
}

INSTANTIATE_TEST_SUITE_P(Of, Divergence,
                         testing::Values(scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

INSTANTIATE_TEST_SUITE_P(Velocity, NonFinite,
                         testing::Values(glm::vec4(nan, 0, 0, 1), glm::vec4(0, 0, infinity, 1),
                                         glm::vec4(0, -infinity, 0, 1), glm::vec4(nan, nan, nan, nan)));

}  // namespace
}  // namespace spherule::physics
