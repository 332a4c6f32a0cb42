#include "scene/quality.h"

#include <gtest/gtest.h>

#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

std::string quality(const std::string& members) {
    return R"("quality": )" + object(members);
}

constexpr const char* halfKnown = R"("materials": [{"young": 1e7}, {"name": "felt"}])";
constexpr const char* felt =
    "materials[1].young: is missing; with one material's modulus given, accurate needs all of them";

TEST(SceneQuality, DefaultsToBalanced) {
    EXPECT_EQ(sceneWith("").quality.model, Model::Balanced);
    EXPECT_EQ(sceneWith(quality("")).quality.model, Model::Balanced);
    EXPECT_EQ(sceneWith("").quality.overlap, 0.1);
}

TEST(SceneQuality, ModelsAreNamed) {
    EXPECT_EQ(sceneWith(quality(R"("model": "FAST")")).quality.model, Model::Fast);
    EXPECT_EQ(sceneWith(quality(R"("model": "BALANCED")")).quality.model, Model::Balanced);
    EXPECT_EQ(sceneWith(quality(R"("model": "ACCURATE")")).quality.model, Model::Accurate);
    EXPECT_EQ(refusalOf(quality(R"("model": 4)")), "quality.model: is 4, must be FAST, BALANCED or ACCURATE");
    EXPECT_EQ(refusalOf(quality(R"("model": -1)")), "quality.model: is -1, must be FAST, BALANCED or ACCURATE");
}

TEST(SceneQuality, NamesAndMessagesAgree) {
    EXPECT_EQ(nameOf(Model::Fast), "fast");
    EXPECT_EQ(nameOf(Model::Balanced), "balanced");
    EXPECT_EQ(nameOf(Model::Accurate), "accurate");
    for (const Model model : {Model::Fast, Model::Balanced, Model::Accurate}) {
        EXPECT_EQ(modelNamed(nameOf(model)), model);
        EXPECT_EQ(modelOf(messageOf(model)), model);
    }
    EXPECT_EQ(messageOf(Model::Balanced), v1::BALANCED);
    EXPECT_FALSE(modelNamed("BALANCED"));
    EXPECT_FALSE(modelNamed(""));
}

TEST(SceneQuality, OverrideReplacesTheModel) {
    const std::string fast = quality(R"("model": "FAST")");
    EXPECT_EQ(sceneWith(fast).quality.substeps, 2U);
    const Quality changed = sceneWith(fast, {.model = Model::Balanced}).quality;
    EXPECT_EQ(changed.model, Model::Balanced);
    EXPECT_EQ(changed.substeps, 8U) << "those of the model that counts";
}

TEST(SceneQuality, SubstepsHaveARange) {
    const std::string range = "must be 1 to 20000 for the 0 spheres of this scene";
    EXPECT_EQ(refusalOf(quality(R"("substeps": 0)")), "quality.substeps: is 0, " + range);
    EXPECT_EQ(refusalOf(quality(R"("substeps": 20001)")), "quality.substeps: is 20001, " + range);
    EXPECT_EQ(refusalOf("", {.substeps = 0}), "quality.substeps: is 0, " + range);
    EXPECT_EQ(sceneWith(quality(R"("substeps": 20000)")).quality.substeps, 20'000U);
}

TEST(SceneQuality, TooLargeDefaultSubstepsAreRefused) {
    const std::string sphere = group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.5], "radius": 0.01}]})");
    const std::string reason = "must be at most 1000000; shorten the step or give substeps";
    const std::string heavy = R"("gravity": [0, 0, -1e9], "step": 1, )" + sphere;
    EXPECT_NE(refusalOf(heavy).find(reason), std::string::npos) << refusalOf(heavy);
    EXPECT_EQ(refusalOf(heavy, {.substeps = 9}), "accepted");
    const std::string stiff = R"("materials": [{"young": 1e15}], )" + quality(R"("model": "ACCURATE")") + ", " + sphere;
    EXPECT_EQ(refusalOf(stiff).find("quality.substeps: would be "), 0U) << refusalOf(stiff);
    EXPECT_NE(refusalOf(stiff).find(reason), std::string::npos) << refusalOf(stiff);
}

TEST(SceneQuality, OverlapHasARange) {
    EXPECT_EQ(sceneWith(quality(R"("overlap": 0.5)")).quality.overlap, 0.5);
    EXPECT_EQ(sceneWith(quality(R"("overlap": 1e-6)")).quality.overlap, 1e-6);
    EXPECT_EQ(refusalOf(quality(R"("overlap": 0)")), "quality.overlap: is 0, must be 1e-06 to 0.5");
    EXPECT_EQ(refusalOf(quality(R"("overlap": 0.6)")), "quality.overlap: is 0.6, must be 1e-06 to 0.5");
    EXPECT_EQ(refusalOf(quality(R"("overlap": -0.01)")), "quality.overlap: is -0.01, must be 1e-06 to 0.5");
}

TEST(SceneQuality, AutoGoalHasARange) {
    EXPECT_FALSE(sceneWith("").quality.goal);
    EXPECT_EQ(sceneWith(quality(R"("auto": {"budgetMs": 16})")).quality.goal,
              (QualityGoal{QualityGoal::Kind::StepTime, 16}));
    EXPECT_EQ(sceneWith(quality(R"("auto": {"overlap": 0.005})")).quality.goal,
              (QualityGoal{QualityGoal::Kind::Overlap, 0.005}));
    EXPECT_FALSE(sceneWith(quality(R"("auto": {})")).quality.goal);
    EXPECT_EQ(refusalOf(quality(R"("auto": {"budgetMs": 0})")), "quality.auto.budgetMs: is 0, must be positive");
    EXPECT_EQ(refusalOf(quality(R"("auto": {"budgetMs": 60001})")),
              "quality.auto.budgetMs: is 60001, must be at most 60000 ms");
    EXPECT_EQ(refusalOf(quality(R"("auto": {"overlap": 0.6})")), "quality.auto.overlap: is 0.6, must be 1e-06 to 0.5");
}

TEST(SceneQuality, OverrideOfModelOrSubstepsRemovesTheAutoGoal) {
    const std::string held = quality(R"("auto": {"budgetMs": 16})");
    EXPECT_FALSE(sceneWith(held, {.substeps = 4}).quality.goal);
    EXPECT_FALSE(sceneWith(held, {.model = Model::Fast}).quality.goal);
    const QualityGoal other{QualityGoal::Kind::Overlap, 0.01};
    EXPECT_EQ(sceneWith(held, {.substeps = 4, .goal = other}).quality.goal, other);
}

TEST(SceneQuality, ModelsHaveASubstepRange) {
    const Scene scene = sceneWith("");
    EXPECT_EQ(substepRange(scene, Model::Balanced).fewest, 4U);
    EXPECT_EQ(substepRange(scene, Model::Balanced).most, 64U);
    EXPECT_EQ(substepRange(scene, Model::Fast).fewest, 1U) << "none is too few";
    const Scene stiff = sceneWith(R"("materials": [{"young": 1e7}])", {.model = Model::Accurate});
    Scene fewest = stiff;
    fewest.quality.substepsFixed = true;
    fewest.quality.substeps = minSubstepsFor(stiff, Model::Accurate);
    EXPECT_TRUE(fitSubsteps(fewest));
    --fewest.quality.substeps;
    EXPECT_FALSE(fitSubsteps(fewest));
    EXPECT_GE(substepRange(stiff, Model::Accurate).fewest, minSubstepsFor(stiff, Model::Accurate));
    EXPECT_EQ(substepsFor(scene, Model::Balanced), 8U);
    EXPECT_FALSE(substepsFor(sceneWith(halfKnown), Model::Accurate));
}

TEST(SceneQuality, AccurateNeedsModuliOfAllMaterialsOrNone) {
    const std::string accurate = quality(R"("model": "ACCURATE")");
    EXPECT_EQ(refusalOf(std::string(halfKnown) + ", " + accurate), felt);
    EXPECT_EQ(refusalOf(halfKnown, {.model = Model::Accurate}), felt);
    EXPECT_EQ(refusalOf(R"("materials": [{}, {"name": "felt"}], )" + accurate), "accepted");
    EXPECT_EQ(refusalOf(R"("materials": [{"young": 1e7}, {"name": "felt", "young": 1e6}], )" + accurate), "accepted");
}

TEST(SceneQuality, OtherModelsIgnoreModuli) {
    for (const Model model : {Model::Fast, Model::Balanced}) {
        Scene scene = sceneWith(halfKnown, {.model = model});
        EXPECT_TRUE(checkModel(scene));
        scene.quality.model = Model::Accurate;
        ASSERT_FALSE(checkModel(scene));
        EXPECT_EQ(checkModel(scene).error().text(), felt);
    }
}

}  // namespace
}  // namespace spherule::scene::testing
