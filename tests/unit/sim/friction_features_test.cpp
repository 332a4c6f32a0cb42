// The features that friction and rolling resistance require.
#include <gtest/gtest.h>

#include "scene_support.h"
#include "sim/features.h"

namespace spherule::sim {
namespace {

using scene::testing::parsed;

// Returns the features of two spheres of the material "ball" in a closed cube of "wall". `more`: further members.
Features featuresWith(const std::string& ball, const std::string& wall, const std::string& more = "") {
    const auto scene =
        scene::build(parsed(R"({"bounds": {"min": [0,0,0], "max": [1,1,1], "material": "wall"}, "groups": [
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

TEST(SimFriction, IsOfSpheresWithEachOther) {
    EXPECT_FALSE(featuresWith(smooth, smooth).has(Feature::Friction));
    EXPECT_TRUE(featuresWith(rough, smooth).has(Feature::Friction));
    EXPECT_FALSE(featuresWith(rough, smooth, apart).has(Feature::Friction)) << "they never meet";
}

TEST(SimFriction, OfAWallCountsWithTheSpheres) {
    EXPECT_TRUE(featuresWith(rough, rough, apart).has(Feature::Friction));
    EXPECT_FALSE(featuresWith(smooth, rough).has(Feature::Friction)) << "the geometric mean is zero";
    EXPECT_TRUE(featuresWith(smooth, smooth, pairOf("wall", "ball", rough)).has(Feature::Friction));
    EXPECT_TRUE(featuresWith(smooth, rough, pairOf("ball", "wall", rough)).has(Feature::Friction));
    EXPECT_FALSE(featuresWith(rough, rough, apart + pairOf("ball", "wall", smooth)).has(Feature::Friction));
}

TEST(SimFriction, OfAnObstacleCountsWithTheSpheres) {
    const std::string plate = R"(, "obstacles": [{"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}, "material": )";
    EXPECT_TRUE(featuresWith(rough, smooth, apart + plate + R"("ball"}])").has(Feature::Friction));
    EXPECT_FALSE(featuresWith(rough, smooth, apart + plate + R"("wall"}])").has(Feature::Friction));
}

TEST(SimFriction, OfMaterialsThatNoSphereHasDoesNotCount) {
    EXPECT_FALSE(featuresWith(smooth, smooth, pairOf("wall", "wall", rough)).has(Feature::Friction))
        << "a wall meets no wall";
    const Features features = featuresOf(
        scene::testing::sceneWith(R"("materials": [{"restitution": 0},
        {"name": "felt", "restitution": 0.9, "friction": 0.9, "rollingResistance": 0.9, "young": 1e7}], )" +
                                  scene::testing::group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.5]}]},
                                                            "radius": {"constant": 0.1})")));
    EXPECT_FALSE(features.has(Feature::Friction));
    EXPECT_FALSE(features.has(Feature::Rolling));
    EXPECT_FALSE(features.has(Feature::Restitution));
    EXPECT_FALSE(features.has(Feature::Materials));
    EXPECT_FALSE(features.has(Feature::Hertz));
}

TEST(SimFriction, RollingResistanceNeedsIt) {
    const std::string rolling = R"(, "rollingResistance": 0.1)";
    const std::string spinning = R"(, "spinningResistance": 0.1)";
    EXPECT_FALSE(featuresWith(rough, rough).has(Feature::Rolling));
    for (const std::string& resistance : {rolling, spinning}) {
        EXPECT_TRUE(featuresWith(rough + resistance, smooth).has(Feature::Rolling));
        EXPECT_FALSE(featuresWith(smooth + resistance, smooth + resistance).has(Feature::Rolling)) << "nothing turns";
        EXPECT_FALSE(featuresWith(rough, rough + resistance).has(Feature::Rolling)) << "the geometric mean is zero";
        EXPECT_TRUE(featuresWith(rough, rough, pairOf("ball", "wall", resistance.substr(2))).has(Feature::Rolling));
    }
}

}  // namespace
}  // namespace spherule::sim
