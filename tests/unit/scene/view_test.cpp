#include "scene/view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

#include "scene/describe.h"
#include "scene/materials.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

// Returns the largest distance of a corner of the bounds from the middle of the picture; the edge is at 1.
double reachInPicture(const Camera& camera, const Bounds& bounds, double aspect) {
    const glm::dvec3 forward = glm::normalize(camera.target - camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1)));
    const glm::dvec3 up = glm::cross(right, forward);
    const double slope = std::tan(0.5 * glm::radians(camera.fieldOfView));
    double reach = 0;
    for (const double x : {bounds.min.x, bounds.max.x}) {
        for (const double y : {bounds.min.y, bounds.max.y}) {
            for (const double z : {bounds.min.z, bounds.max.z}) {
                const glm::dvec3 p = glm::dvec3(x, y, z) - camera.eye;
                const double depth = slope * glm::dot(p, forward);
                EXPECT_GT(depth, 0);
                reach = std::max(
                    {reach, std::abs(glm::dot(p, right)) / (depth * aspect), std::abs(glm::dot(p, up)) / depth});
            }
        }
    }
    return reach;
}

TEST(SceneView, DefaultCameraShowsTheBounds) {
    for (const Box& box : {Box{{0, 0, 0}, {1, 1, 1}}, Box{{-10, 5, 0}, {30, 6, 0.5}}, Box{{0, 0, -7}, {0.1, 0.1, 3}}}) {
        Bounds bounds;
        bounds.min = box.min;
        bounds.max = box.max;
        for (const double fieldOfView : {20.0, 45.0, 100.0}) {
            const double reach = reachInPicture(framing(bounds, fieldOfView), bounds, 1.5);
            EXPECT_LT(reach, 1);
            EXPECT_GT(reach, 0.8);
        }
    }
}

TEST(SceneView, GivenCameraIsUsed) {
    const Scene scene = sceneWith(R"("camera": {"eye": [1, 2, 3], "target": [4, 5, 6], "fieldOfView": 60})");
    EXPECT_EQ(scene.camera.eye, glm::dvec3(1, 2, 3));
    EXPECT_EQ(scene.camera.target, glm::dvec3(4, 5, 6));
    EXPECT_EQ(scene.camera.fieldOfView, 60);
}

TEST(SceneView, CamerasAreChecked) {
    EXPECT_EQ(refusalOf(R"("camera": {"eye": [1, 2, 3], "target": [1, 2, 3]})"),
              "camera.target: is where the eye is; move one of them");
    EXPECT_EQ(refusalOf(R"("camera": {"eye": [1]})"), "camera.eye: has 1 number, must have three: x, y, z");
    EXPECT_EQ(refusalOf(R"("camera": {"fieldOfView": 200})"), "camera.fieldOfView: is 200, must be 1 to 150 degrees");
}

// Returns the bounds up to the highest sphere. If the scene has no walls, returns the bounds of the spheres.
Bounds contentsOf(const Scene& scene) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Bounds contents;
    contents.min = glm::dvec3(infinity);
    contents.max = glm::dvec3(-infinity);
    forEachSphere(scene, [&](const Sphere& s, double /*weight*/) {
        contents.min = glm::min(contents.min, s.position - static_cast<double>(s.radius));
        contents.max = glm::max(contents.max, s.position + static_cast<double>(s.radius));
    });
    if (!hasWalls(scene)) return contents;
    const double top = contents.max.z;
    contents.min = scene.bounds.min;
    contents.max = scene.bounds.max;
    contents.max.z = top;
    return contents;
}

TEST(SceneView, ExampleScenesAreFullyVisible) {
    for (const std::string& name : names()) {
        const Scene scene = *load(name, "software");
        const double reach = reachInPicture(scene.camera, contentsOf(scene), 16.0 / 9);
        EXPECT_LT(reach, 1) << name;
        EXPECT_GT(reach, 0.35) << name;
    }
}

TEST(SceneView, LightIsReadAndPassedOn) {
    EXPECT_FALSE(sceneWith("").light);
    const auto light =
        sceneWith(R"("light": {"direction": [0, 3, 4], "strength": 2, "colour": "#ffeedd", "sky": 0})").light;
    ASSERT_TRUE(light);
    EXPECT_LT(glm::distance(*light->direction, glm::dvec3(0, 0.6, 0.8)), 1e-12);
    EXPECT_EQ(describe(sceneWith(R"("light": {"strength": 2})"), 0).light().strength(), 2) << "in a saved scene";
    EXPECT_FALSE(describe(sceneWith(""), 0).has_light());
    const v1::Light message = messageOf(*light);
    EXPECT_NEAR(message.direction(2), 0.8, 1e-12);
    EXPECT_EQ(message.strength(), 2);
    EXPECT_EQ(message.colour(), "#ffeedd");
    EXPECT_EQ(message.sky(), 0);
    const v1::Light usual = messageOf(*sceneWith(R"("light": {})").light);
    EXPECT_EQ(usual.direction_size(), 0);
    EXPECT_EQ(usual.strength(), 1);
    EXPECT_EQ(usual.sky(), 1);
}

TEST(SceneView, LightIsInItsRanges) {
    EXPECT_EQ(refusalOf(R"("light": {"direction": [0, 0, 0]})"), "light.direction: has no length");
    EXPECT_EQ(refusalOf(R"("light": {"direction": [1, 0]})"),
              "light.direction: has 2 numbers, must have three: x, y, z");
    EXPECT_EQ(refusalOf(R"("light": {"strength": 11})"), "light.strength: is 11, must be 0 to 10");
    EXPECT_EQ(refusalOf(R"("light": {"sky": -1})"), "light.sky: is -1, must be 0 to 10");
    EXPECT_EQ(refusalOf(R"("light": {"colour": "white"})"),
              R"(light.colour: is "white", must be #rrggbb in hexadecimal)");
}

}  // namespace
}  // namespace spherule::scene::testing
