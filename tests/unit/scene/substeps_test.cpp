// Substeps that the scene sets, and substeps that the program chooses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/quality.h"
#include "scene/stiffness.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

// Two spheres of 5 cm with this quality and this material.
Scene sceneOf(const std::string& quality, const std::string& material = "", const Overrides& overrides = {}) {
    return sceneWith("\"quality\": " + object(quality) + ", \"materials\": [" + object(material) + "], " +
                         group(R"("list": {"spheres": [{"position": [0.3, 0.5, 0.5]}, {"position": [0.7, 0.5, 0.5]}]},
                                  "radius": {"constant": 0.05})"),
                     overrides);
}

constexpr double pi = std::numbers::pi;
constexpr const char* accurate = R"("model": "ACCURATE")";
constexpr const char* rubber = R"("young": 1e7)";

std::string refusalBy(Scene& scene) {
    const auto fits = fitSubsteps(scene);
    return fits ? "accepted" : fits.error().text();
}

TEST(SceneSubsteps, AreFixedByTheSceneOrAnOverride) {
    EXPECT_FALSE(sceneOf("").quality.substepsFixed);
    EXPECT_TRUE(sceneOf(R"("substeps": 8)").quality.substepsFixed);
    EXPECT_TRUE(sceneOf("", "", {.substeps = 8}).quality.substepsFixed);
    EXPECT_FALSE(sceneOf("", "", {.model = Model::Fast}).quality.substepsFixed);
}

TEST(SceneSubsteps, AreRecomputedUnlessFixed) {
    Scene chosen = sceneOf("");
    ASSERT_EQ(chosen.quality.substeps, 8U);
    chosen.forces.gravity *= 4;
    EXPECT_EQ(refusalBy(chosen), "accepted");
    EXPECT_EQ(chosen.quality.substeps, 16U);
    chosen.spheres[1].radius /= 4;
    EXPECT_EQ(refusalBy(chosen), "accepted");
    EXPECT_EQ(chosen.quality.substeps, 32U);
    chosen.quality.model = Model::Fast;
    EXPECT_EQ(refusalBy(chosen), "accepted");
    EXPECT_EQ(chosen.quality.substeps, 8U);

    Scene pinned = sceneOf(R"("substeps": 3)");
    pinned.forces.gravity *= 4;
    pinned.quality.model = Model::Fast;
    EXPECT_EQ(refusalBy(pinned), "accepted");
    EXPECT_EQ(pinned.quality.substeps, 3U);
    pinned.quality.substepsFixed = false;
    EXPECT_EQ(refusalBy(pinned), "accepted");
    EXPECT_EQ(pinned.quality.substeps, 4U);
}

TEST(SceneSubsteps, HaveARange) {
    Scene scene = sceneOf(R"("substeps": 3)");
    scene.quality.substeps = 0;
    EXPECT_EQ(refusalBy(scene), "quality.substeps: is 0, must be 1 to 19996 for the 2 spheres of this scene");
    scene.quality.substeps = maxSubsteps + 1;
    EXPECT_EQ(refusalBy(scene), "quality.substeps: is 1000001, must be 1 to 19996 for the 2 spheres of this scene");
    scene.quality.substepsFixed = false;
    EXPECT_EQ(refusalBy(scene), "accepted") << "what was there does not count";
    EXPECT_EQ(scene.quality.substeps, 8U);
    scene.forces.gravity *= 1e12;
    EXPECT_EQ(refusalBy(scene).find("quality.substeps: would be "), 0U) << refusalBy(scene);
}

TEST(SceneSubsteps, AreAtLeastTenPerContactOfGivenModuli) {
    const double contact = contactTimeOf(sceneOf(accurate, rubber)).contact;
    const auto fewest = static_cast<std::uint32_t>(std::ceil(10 / 60.0 / contact));
    ASSERT_GT(fewest, 10U);
    Scene scene = sceneOf(accurate, rubber, {.substeps = fewest});
    EXPECT_EQ(refusalBy(scene), "accepted");
    scene.quality.substeps = fewest - 1;
    EXPECT_EQ(refusalBy(scene), "quality.substeps: is " + std::to_string(fewest - 1) +
                                    ", but contacts of these materials would take less than 10 substeps then; give at "
                                    "least " +
                                    std::to_string(fewest));
    for (const Model model : {Model::Fast, Model::Balanced}) {
        scene.quality.model = model;
        EXPECT_EQ(refusalBy(scene), "accepted") << "it has no contacts that take time";
    }
}

TEST(SceneSubsteps, WithGivenModuliAreCheckedWhenASceneIsBuilt) {
    const std::string half = R"("model": "ACCURATE", "substeps": 2)";
    EXPECT_EQ(refusalOf("\"quality\": " + object(half) + R"(, "materials": [{"young": 1e9}], )" +
                        group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.5], "radius": 0.05}]})"))
                  .find("quality.substeps: is 2, but contacts of these materials"),
              0U);
}

TEST(SceneSubsteps, HaveAMinimumThatLimitsOverlaps) {
    Scene softest = sceneOf(R"("model": "ACCURATE", "overlap": 0.5)");
    const std::uint32_t fewest = softest.quality.substeps;
    EXPECT_EQ(minSubstepsFor(sceneOf(accurate), Model::Accurate), fewest) << "whatever overlap is asked for";
    softest.quality.substepsFixed = true;
    EXPECT_EQ(refusalBy(softest), "accepted");
    softest.quality.substeps = fewest - 1;
    EXPECT_EQ(refusalBy(softest), "quality.substeps: is " + std::to_string(fewest - 1) +
                                      ", but springs so soft would give way by 50 % of a radius; give at least " +
                                      std::to_string(fewest));
    softest.quality.goal = {QualityGoal::Kind::StepTime, 16};
    EXPECT_EQ(refusalBy(softest), "accepted") << "nobody asked for these";
    EXPECT_EQ(softest.quality.substeps, fewest);
}

// omega^2 is stiffness over mass, and for liquids 3/4 g / r times the ratio of the densities: 0.2 rad in a substep.
TEST(SceneSubsteps, FollowTheFrequencyOfFields) {
    constexpr double mass = 4.0 / 3 * pi * 0.05 * 0.05 * 0.05 * 1000;
    for (const Model model : {Model::Fast, Model::Balanced, Model::Accurate}) {
        Scene scene = sceneOf(R"("overlap": 0.5)");
        scene.quality.model = model;
        scene.forces.fields = {Spring{.stiffness = 300 * 300 * mass, .damping = 1}, Drag{}};
        EXPECT_GE(minSubstepsFor(scene, model), 25U);
        EXPECT_EQ(refusalBy(scene), "accepted");
        EXPECT_GE(scene.quality.substeps, 25U);
        scene.quality.substepsFixed = true;
        scene.quality.substeps = 24;
        if (model == Model::Accurate) continue;
        EXPECT_EQ(refusalBy(scene),
                  "quality.substeps: is 24, but fields swing a sphere at 300 rad/s, and a substep may take at most 0.2 "
                  "rad; give at least 25");
        scene.forces.fields = {Buoyancy{.density = 600 * 1000, .surface = glm::dvec3(0)}};
        EXPECT_EQ(minSubstepsFor(scene, model), std::ceil(std::sqrt(0.75 * 600 * 9.81 / 0.05) / 60 / 0.2));
    }
}

// Wind presses spheres at rest as an acceleration does.
TEST(SceneSubsteps, FollowTheWind) {
    Scene scene = sceneOf("");
    const double still = defaultSubsteps(scene);
    scene.forces.fields = {Drag{}};
    EXPECT_EQ(defaultSubsteps(scene), still);
    scene.forces.fields = {Drag{.velocity = {200, 0, 0}}};
    EXPECT_GT(defaultSubsteps(scene), 2 * still);
}

TEST(SceneSubsteps, FixedSubstepsDetermineTheStiffness) {
    for (const std::uint32_t substeps : {100U, 400U, 1000U}) {
        const Scene scene = sceneOf(accurate, "", {.substeps = substeps});
        const double substep = scene.step / substeps;
        EXPECT_NEAR(contactTimeOf(scene).contact, 70 * substep, 1e-9);
        const double mass = 4.0 / 3 * pi * std::pow(0.05, 3) * 1000;
        const double stiffness = springModulus(scene) * 0.05;
        EXPECT_NEAR(pi * std::sqrt(mass / 2 / stiffness) / substep, 70, 1e-4);
    }
}

TEST(SceneSubsteps, FixedSubstepsMakeStiffnessIndependentOfOverlapAndSpeed) {
    const Scene scene = sceneOf(accurate, "", {.substeps = 500});
    const double modulus = springModulus(scene);
    Scene changed = scene;
    changed.quality.overlap = 0.01;
    changed.spheres[0].velocity = {10, 0, 0};
    changed.forces.gravity *= 2;
    EXPECT_EQ(springModulus(changed), modulus);
    changed.quality.substepsFixed = false;
    EXPECT_NE(springModulus(changed), modulus);
    changed = scene;
    changed.quality.substeps = 1000;
    EXPECT_NEAR(springModulus(changed) / modulus, 4, 1e-9);
}

TEST(SceneSubsteps, FixedSubstepsSufficeForTheSmallestAndLightestSphere) {
    Scene scene = sceneOf(accurate, "", {.substeps = 500});
    const double modulus = springModulus(scene);
    scene.materials.push_back({.name = "cork", .density = 250});
    EXPECT_EQ(springModulus(scene), modulus) << "nothing is of cork";
    scene.spheres[1].material = 1;
    EXPECT_NEAR(springModulus(scene) / modulus, 0.25, 1e-9);
    scene.spheres[0].radius /= 2;
    EXPECT_NEAR(springModulus(scene) / modulus, 0.0625, 1e-6);
    EXPECT_NEAR(contactTimeOf(scene).contact, 70 * scene.step / 500, 1e-9);
}

TEST(SceneSubsteps, AutomaticSubstepsMatchTheContactTime) {
    for (const std::string overlap : {"0.1", "0.01"}) {
        const Scene scene = sceneOf(accurate + (R"(, "overlap": )" + overlap));
        const double contact = contactTimeOf(scene).contact;
        EXPECT_EQ(scene.quality.substeps, std::ceil(70 * scene.step / contact));
    }
}

}  // namespace
}  // namespace spherule::scene::testing
