#include <gtest/gtest.h>

#include "scene/check.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

TEST(SceneRefusals, AnEmptySceneWithBoundsIsAccepted) {
    const Scene scene = sceneWith("");
    EXPECT_TRUE(scene.spheres.empty());
    EXPECT_EQ(scene.gravity, glm::dvec3(0, 0, -9.81));
    EXPECT_EQ(scene.restitution, 0.5);
    EXPECT_EQ(scene.step, 1.0 / 60);
    EXPECT_EQ(scene.substeps, 8U);
    EXPECT_TRUE(scene.sleep.enabled);
    EXPECT_EQ(scene.sleep.speed, 0.02);
    EXPECT_EQ(scene.sleep.time, 0.5);
    EXPECT_TRUE(scene.sphereContacts);
}

TEST(SceneRefusals, VectorsHaveThreeNumbers) {
    EXPECT_EQ(refusalOf(R"("gravity": [0, 0])"), "gravity: has 2 numbers, must have three: x, y, z");
    EXPECT_EQ(refusalOf(R"("gravity": [1])"), "gravity: has 1 number, must have three: x, y, z");
    EXPECT_EQ(refusalOf(R"("gravity": [0, 0, 0, 0])"), "gravity: has 4 numbers, must have three: x, y, z");
}

TEST(SceneRefusals, NumbersAreFinite) {
    EXPECT_EQ(refusalOf(R"("gravity": [0, 0, "NaN"])"), "gravity[2]: is nan, must be a finite number");
    EXPECT_EQ(refusalOf(R"("gravity": [0, "-Infinity", 0])"), "gravity[1]: is -inf, must be a finite number");
    EXPECT_EQ(refusalOf(R"("restitution": "NaN")"), "restitution: is nan, must be a finite number");
    EXPECT_EQ(refusalOf(R"("step": "NaN")"), "step: is nan, must be a finite number");
    EXPECT_EQ(refusalOf(R"("sleep": {"speed": "Infinity"})"), "sleep.speed: is inf, must be a finite number");
    EXPECT_EQ(refusalOf(R"("camera": {"fieldOfView": "NaN"})"), "camera.fieldOfView: is nan, must be a finite number");
    EXPECT_EQ(refusalOf(group(R"("list": {}, "radius": {"constant": "NaN"})")),
              "groups[0].radius.constant: is nan, must be a finite number");
    EXPECT_EQ(refusalOf(group(R"("list": {}, "density": "NaN")")),
              "groups[0].density: is nan, must be a finite number");
    EXPECT_EQ(refusalOf(group(R"("lattice": {"min": [0,0,0], "max": [1,1,1], "spacing": "NaN"},
                                 "radius": {"constant": 0.1})")),
              "groups[0].lattice.spacing: is nan, must be a finite number");
}

TEST(SceneRefusals, NumbersFitTheSimulation) {
    EXPECT_EQ(refusalOf(R"("gravity": [0, 0, 1e300])"), "gravity[2]: is 1e+300, must be -1000000000 to 1000000000");
}

TEST(SceneRefusals, RestitutionIsZeroToOne) {
    EXPECT_EQ(refusalOf(R"("restitution": 1.1)"), "restitution: is 1.1, must be 0 to 1");
    EXPECT_EQ(refusalOf(group(R"("list": {}, "restitution": -0.1)")), "groups[0].restitution: is -0.1, must be 0 to 1");
    EXPECT_EQ(refusalOf(R"("restitution": 1)"), "accepted");
    EXPECT_EQ(refusalOf(R"("restitution": 0)"), "accepted");
}

TEST(SceneRefusals, StepAndSubstepsHaveARange) {
    EXPECT_EQ(refusalOf(R"("step": 0)"), "step: is 0, must be 1e-06 to 1 s");
    EXPECT_EQ(refusalOf(R"("step": 1.5)"), "step: is 1.5, must be 1e-06 to 1 s");
    EXPECT_EQ(refusalOf(R"("substeps": 0)"), "substeps: is 0, must be 1 to 10000");
    EXPECT_EQ(refusalOf(R"("substeps": 10001)"), "substeps: is 10001, must be 1 to 10000");
    EXPECT_EQ(refusalOf("", {.substeps = 0}), "substeps: is 0, must be 1 to 10000");
    EXPECT_EQ(sceneWith(R"("substeps": 10000)").substeps, 10000U);
}

TEST(SceneRefusals, ADefaultOfTooManySubstepsIsRefusedWithItsReason) {
    const std::string text = refusalOf(R"("gravity": [0, 0, -1e9], )" +
                                       group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.5], "radius": 0.1}]})"));
    EXPECT_NE(text.find("must be at most 10000; shorten the step or give substeps"), std::string::npos) << text;
}

TEST(SceneRefusals, SleepHasPositiveLimits) {
    EXPECT_EQ(refusalOf(R"("sleep": {"speed": 0})"), "sleep.speed: is 0, must be positive");
    EXPECT_EQ(refusalOf(R"("sleep": {"time": -1})"), "sleep.time: is -1, must be positive");
    EXPECT_EQ(refusalOf(R"("sleep": {"time": 1e6})"), "sleep.time: is 1000000, must be at most 3600 s");
}

TEST(SceneRefusals, ColoursAreHexadecimal) {
    EXPECT_EQ(refusalOf(group(R"("list": {}, "colour": "red")")),
              R"(groups[0].colour: is "red", must be #rrggbb in hexadecimal)");
    EXPECT_EQ(refusalOf(group(R"("list": {}, "colour": "#12345g")")),
              R"(groups[0].colour: is "#12345g", must be #rrggbb in hexadecimal)");
    EXPECT_EQ(refusalOf(group(R"("list": {}, "colour": "#1A2b3C")")), "accepted");
}

TEST(SceneRefusals, TextInAMessageIsCutAndPrintable) {
    const std::string text = refusalOf(group(R"("list": {}, "colour": "\n)" + std::string(1000, 'x') + "\""));
    EXPECT_EQ(text, "groups[0].colour: is \"?" + std::string(39, 'x') + "...\", must be #rrggbb in hexadecimal");
}

TEST(SceneRefusals, TheFirstOfSeveralErrorsIsReported) {
    EXPECT_EQ(refusalOf(R"("gravity": [1], "restitution": 7)"), "gravity: has 1 number, must have three: x, y, z");
}

TEST(SceneRefusals, VectorOfNamesItsField) {
    Numbers values;
    for (const double v : {1.0, 2.0}) values.Add(v);
    EXPECT_EQ(vectorOf(values, "impulse").error().text(), "impulse: has 2 numbers, must have three: x, y, z");
    values.Add(3.0);
    EXPECT_EQ(*vectorOf(values, "impulse"), glm::dvec3(1, 2, 3));
}

}  // namespace
}  // namespace spherule::scene::testing
