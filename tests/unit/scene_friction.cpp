// What friction and resistance require of a simulation.
#include <gtest/gtest.h>

#include "scene/features.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

// Two spheres of "ball" in a closed cube of "wall", with these further members.
Features featuresWith(const std::string& ball, const std::string& wall, const std::string& more = "") {
    const auto scene = build(parsed(R"({"bounds": {"min": [0,0,0], "max": [1,1,1], "material": "wall"}, "groups": [
        {"list": {"spheres": [{"position": [0.3, 0.3, 0.3]}, {"position": [0.6, 0.6, 0.6]}]},
         "radius": {"constant": 0.1}, "material": "ball"}],
        "materials": [{"name": "ball", )" +
                                    ball + R"(}, {"name": "wall", )" + wall + "}]" + more + "}"));
    EXPECT_TRUE(scene) << scene.error().text();
    return featuresOf(*scene);
}

constexpr const char* smooth = R"("friction": 0)";
constexpr const char* rough = R"("friction": 0.5)";
constexpr const char* apart = R"(, "sphereContacts": false)";

std::string pairOf(const std::string& a, const std::string& b, const std::string& members) {
    return R"(, "pairs": [{"a": ")" + a + R"(", "b": ")" + b + R"(", )" + members + "}]";
}

TEST(SceneFriction, IsOfSpheresWithEachOther) {
    EXPECT_FALSE(featuresWith(smooth, smooth).friction);
    EXPECT_TRUE(featuresWith(rough, smooth).friction);
    EXPECT_FALSE(featuresWith(rough, smooth, apart).friction) << "they never meet";
}

TEST(SceneFriction, OfAWallCountsWithTheSpheres) {
    EXPECT_TRUE(featuresWith(rough, rough, apart).friction);
    EXPECT_FALSE(featuresWith(smooth, rough).friction) << "the geometric mean is zero";
    EXPECT_TRUE(featuresWith(smooth, smooth, pairOf("wall", "ball", rough)).friction);
    EXPECT_TRUE(featuresWith(smooth, rough, pairOf("ball", "wall", rough)).friction);
    EXPECT_FALSE(featuresWith(rough, rough, apart + pairOf("ball", "wall", smooth)).friction);
}

TEST(SceneFriction, OfAnObstacleCountsWithTheSpheres) {
    const std::string plate = R"(, "obstacles": [{"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}, "material": )";
    EXPECT_TRUE(featuresWith(rough, smooth, apart + plate + R"("ball"}])").friction);
    EXPECT_FALSE(featuresWith(rough, smooth, apart + plate + R"("wall"}])").friction);
}

TEST(SceneFriction, OfMaterialsThatNoSphereHasDoesNotCount) {
    EXPECT_FALSE(featuresWith(smooth, smooth, pairOf("wall", "wall", rough)).friction) << "a wall meets no wall";
    const Features features = featuresOf(sceneWith(R"("materials": [{"restitution": 0},
        {"name": "felt", "restitution": 0.9, "friction": 0.9, "rollingResistance": 0.9, "young": 1e7}], )" +
                                                   group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.5]}]},
                                                            "radius": {"constant": 0.1})")));
    EXPECT_FALSE(features.friction);
    EXPECT_FALSE(features.rolling);
    EXPECT_FALSE(features.restitution);
    EXPECT_FALSE(features.materials);
    EXPECT_FALSE(features.hertz);
}

TEST(SceneFriction, RollingResistanceNeedsIt) {
    const std::string rolling = R"(, "rollingResistance": 0.1)";
    const std::string spinning = R"(, "spinningResistance": 0.1)";
    EXPECT_FALSE(featuresWith(rough, rough).rolling);
    for (const std::string& resistance : {rolling, spinning}) {
        EXPECT_TRUE(featuresWith(rough + resistance, smooth).rolling);
        EXPECT_FALSE(featuresWith(smooth + resistance, smooth + resistance).rolling) << "nothing turns";
        EXPECT_FALSE(featuresWith(rough, rough + resistance).rolling) << "the geometric mean is zero";
        EXPECT_TRUE(featuresWith(rough, rough, pairOf("ball", "wall", resistance.substr(2))).rolling);
    }
}

}  // namespace
}  // namespace spherule::scene::testing
