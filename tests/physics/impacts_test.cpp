// The device counts impacts correctly, and counting does not change the simulation.
#include <gtest/gtest.h>

#include <string>

#include "scene/quality.h"
#include "scene/random.h"
#include "support.h"

namespace spherule::physics {
namespace {

constexpr double within = 0.005;

// A gas of 200 spheres between walls.
scene::Scene gas(scene::Model model, double restitution, std::uint64_t seed = 3) {
    scene::Scene scene = fineStepBox(2);
    scene.forces.gravity = {};
    scene.quality.model = model;
    scene::Random random(seed);
    const auto speed = [&random] { return static_cast<float>(random.uniform(-3, 3)); };
    for (int k = 0; k < 200; ++k) {
        scene::Sphere sphere;
        sphere.radius = k % 2 == 0 ? 0.04F : 0.06F;
        sphere.position = 0.3 * (glm::dvec3(k % 6, k / 6 % 6, k / 36) - 2.5);
        sphere.velocity = {speed(), speed(), speed()};
        scene.spheres.push_back(sphere);
    }
    setRestitution(scene, restitution);
    return scene;
}

// 32 pairs, each in its own lane. Pair n collides head-on in the middle of step n.
scene::Scene headOn(scene::Model model, double restitution) {
    scene::Scene scene = fineStepSpace(8);
    scene.quality.model = model;
    for (int k = 0; k < 32; ++k) {
        const double half = 0.05 + (k + 0.5) * scene.step;
        const glm::dvec3 lane(0, 0.4 * (k % 8) - 1.4, 0.4 * (k / 8) - 0.6);
        scene.spheres.push_back({lane - glm::dvec3(half, 0, 0), {1, 0, 0}, 0.05F});
        scene.spheres.push_back({lane + glm::dvec3(half, 0, 0), {-1, 0, 0}, 0.05F});
    }
    setRestitution(scene, restitution);
    return scene;
}

class Impacts : public testing::TestWithParam<std::tuple<scene::Model, double>> {
  protected:
    [[nodiscard]] static scene::Model model() { return std::get<0>(GetParam()); }
    [[nodiscard]] static double restitution() { return std::get<1>(GetParam()); }
};

TEST_P(Impacts, OfPairsAreCountedWithTheirRestitution) {
    const auto simulation = simulate(headOn(model(), restitution()));
    run(*simulation, 40 * simulation->scene().step);
    const sim::Impacts seen = simulation->statistics().impacts;
    ASSERT_EQ(seen.count, 2);
    EXPECT_NEAR(seen.approach, 4, 1e-5);
    EXPECT_NEAR(seen.restitution(), restitution(), 1e-5);
    EXPECT_NEAR(seen.restitutionAsked(), restitution(), 1e-6);
    EXPECT_EQ(simulation->statistics().impacts.count, 2) << "looking again adds nothing";
}

// A second impact of a sphere within a substep changes what is seen of the first. Each gas has about a hundred impacts,
// of which up to three are seen wrong, so many gases are needed.
TEST_P(Impacts, OfAGasHaveTheRestitutionOfTheMaterials) {
    double count = 0;
    double seenRestitution = 0;
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
        const auto simulation = simulate(gas(model(), restitution(), seed));
        run(*simulation, 10);
        const sim::Impacts seen = simulation->statistics().impacts;
        EXPECT_NEAR(seen.restitutionAsked(), restitution(), 1e-5);
        count += static_cast<double>(seen.count);
        seenRestitution += static_cast<double>(seen.count) * seen.restitution();
    }
    EXPECT_GT(count, 100);
    EXPECT_NEAR(seenRestitution / count, restitution(), within);
    RecordProperty("impacts", std::to_string(count));
    RecordProperty("restitution", std::to_string(seenRestitution / count));
}

INSTANTIATE_TEST_SUITE_P(Of, Impacts,
                         testing::Combine(testing::Values(scene::Model::Fast, scene::Model::Balanced),
                                          testing::Values(0.5, 0.9)),
                         [](const auto& parameter) {
                             const bool half = std::get<1>(parameter.param) < 0.7;
                             return std::string(scene::nameOf(std::get<0>(parameter.param))) + (half ? "Half" : "High");
                         });

TEST(Observing, DoesNotChangeTheState) {
    for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced}) {
        const auto hashOf = [model](bool observed) {
            scene::Scene scene = gas(model, 0.7);
            scene.forces.gravity = {0, 0, -earth};
            scene.sleep.enabled = true;
            for (scene::Material& material : scene.materials) material.friction = 0.3;
            const auto simulation = simulate(scene);
            simulation->observe(observed);
            for (int k = 0; k < 10; ++k) {
                run(*simulation, 0.05);
                if (observed) static_cast<void>(simulation->statistics());
            }
            EXPECT_EQ(simulation->statistics().impacts.count > 0, observed);
            return sim::hashOf(simulation->snapshot());
        };
        EXPECT_EQ(hashOf(true), hashOf(false)) << scene::nameOf(model);
    }
}

TEST(Observing, IgnoresSpheresAtRest) {
    scene::Scene scene = fineStepBox(0.4);
    scene.spheres = {{{0, 0, -0.15}, {}, 0.05F}, {{0, 0, -0.05}, {}, 0.05F}, {{0.1, 0.1, -0.15}, {}, 0.05F}};
    for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced}) {
        scene.quality.model = model;
        const auto simulation = simulate(scene);
        run(*simulation, 0.5);
        EXPECT_EQ(simulation->statistics().impacts.count, 0) << scene::nameOf(model);
    }
}

TEST(Observing, RestartsAfterReset) {
    const auto simulation = simulate(headOn(scene::Model::Balanced, 0.5));
    run(*simulation, 40 * simulation->scene().step);
    const sim::Impacts before = simulation->statistics().impacts;
    EXPECT_EQ(before.since(before).count, 0);
    ASSERT_TRUE(simulation->apply(sim::Reset()));
    EXPECT_EQ(simulation->statistics().impacts.count, 0);
    run(*simulation, 4 * simulation->scene().step);
    EXPECT_EQ(simulation->statistics().impacts.since(before).count, 1) << "those of before are of another world";
}

// In the model `accurate`, an impact takes many substeps. Impacts are not counted there, and have no array.
TEST(Observing, CountsNoImpactsInTheAccurateModel) {
    scene::Scene scene = headOn(scene::Model::Accurate, 0.5);
    scene.quality.substeps = 100;
    const auto simulation = simulate(scene);
    run(*simulation, 4 * scene.step);
    EXPECT_FALSE(simulation->plan().has(sim::Array::Impacts));
    EXPECT_EQ(simulation->statistics().impacts.count, 0);
}

}  // namespace
}  // namespace spherule::physics
