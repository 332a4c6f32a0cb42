#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "scene/shapes.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

std::string refusalOfBounds(const std::string& bounds, const std::string& more = "") {
    const auto scene = build(parsed(object(R"("bounds": )" + object(bounds) + more)));
    return scene ? "accepted" : scene.error().text();
}

std::string ballAt(const std::string& position, const std::string& radius = "0.1") {
    return group(R"("list": {"spheres": [{"position": )" + position + R"(, "radius": )" + radius + "}]}");
}

TEST(SceneBounds, AreRequired) {
    EXPECT_EQ(build(v1::Scene()).error().text(), "bounds: are missing; give min and max");
}

TEST(SceneBounds, HaveMinBelowMax) {
    EXPECT_EQ(refusalOfBounds(R"("min": [0, 0, 0], "max": [1, 0, 1])"),
              "bounds.max[1]: is 0, must be above min, which is 0");
    EXPECT_EQ(refusalOfBounds(R"("min": [0, 0, 2], "max": [1, 1, 1])"),
              "bounds.max[2]: is 1, must be above min, which is 2");
    EXPECT_EQ(refusalOfBounds(R"("max": [1, 1, 1])"), "bounds.min: has 0 numbers, must have three: x, y, z");
}

TEST(SceneBounds, OpenFacesAreNamed) {
    const Scene scene = *build(parsed(R"({"bounds": {"min": [0,0,0], "max": [1,1,1], "open": ["Z_MAX", "X_MIN"]}})"));
    EXPECT_EQ(scene.bounds.open, (std::array<bool, 6>{true, false, false, false, false, true}));
    EXPECT_EQ(refusalOfBounds(R"("min": [0,0,0], "max": [1,1,1], "open": ["Z_MAX", 9])"),
              "bounds.open[1]: is 9, must be X_MIN, X_MAX, Y_MIN, Y_MAX, Z_MIN or Z_MAX");
    EXPECT_EQ(refusalOfBounds(R"("min": [0,0,0], "max": [1,1,1], "open": ["FACE_UNSPECIFIED"])"),
              "bounds.open[0]: is 0, must be X_MIN, X_MAX, Y_MIN, Y_MAX, Z_MIN or Z_MAX");
}

TEST(SceneBounds, HaveTheFirstMaterialByDefault) {
    const std::string materials = R"("materials": [{"restitution": 0.3}, {"name": "felt", "restitution": 0.9}])";
    const Scene scene = sceneWith(materials);
    EXPECT_EQ(scene.materials[scene.bounds.material].restitution, 0.3);
    const Scene own =
        *build(parsed(object(R"("bounds": {"min": [0,0,0], "max": [1,1,1], "material": "felt"}, )" + materials)));
    EXPECT_EQ(own.materials[own.bounds.material].restitution, 0.9);
    EXPECT_EQ(refusalOfBounds(R"("min": [0,0,0], "max": [1,1,1], "material": "ice")", ", " + materials),
              R"(bounds.material: is "ice", which is no material of the scene; it has "felt")");
}

TEST(SceneBounds, ContainEverySphere) {
    EXPECT_EQ(
        refusalOf(ballAt("[0.05, 0.5, 0.5]")),
        "groups[0].list.spheres[0]: is at (0.05, 0.5, 0.5) with radius 0.1 and reaches x = -0.05, outside the bounds, "
        "which are 0 to 1");
    for (const std::string outside : {"[0.95, 0.5, 0.5]", "[0.5, 0.05, 0.5]", "[0.5, 0.95, 0.5]", "[0.5, 0.5, 0.05]",
                                      "[0.5, 0.5, 0.95]", "[5, 0.5, 0.5]"}) {
        EXPECT_NE(refusalOf(ballAt(outside)).find("outside the bounds"), std::string::npos) << outside;
    }
}

TEST(SceneBounds, ContainEverySphereAtOpenFaces) {
    const std::string text =
        refusalOfBounds(R"("min": [0,0,0], "max": [1,1,1], "open": ["Z_MAX"])", ", " + ballAt("[0.5, 0.5, 0.95]"));
    EXPECT_NE(text.find("reaches z = 1.05, outside the bounds, which are 0 to 1"), std::string::npos) << text;
}

TEST(SceneBounds, MayBeTouched) {
    for (const std::string corner : {"[0.1, 0.1, 0.1]", "[0.9, 0.9, 0.9]"})
        EXPECT_EQ(refusalOf(ballAt(corner)), "accepted");
}

TEST(SceneBounds, AreLimitedByTheResolutionOfFloat32) {
    // The resolution is 2000 m / 2 / 2^23 = 1.19e-4 m. The limit is 1e-4 of the radius: 1 m is too small, 1.2 m is not.
    const std::string bounds = R"("min": [-1000, 0, 0], "max": [1000, 10, 10])";
    EXPECT_EQ(refusalOfBounds(bounds, ", " + ballAt("[5, 5, 5]", "1.2")), "accepted");
    EXPECT_EQ(
        refusalOfBounds(bounds, ", " + ballAt("[5, 5, 5]", "1")),
        "bounds: have a side of 2000 m, where float32 resolves 0.000119 m; the smallest radius of 1 m needs 0.0001 m: "
        "make them at most 1677.72 m long, or enlarge spheres");
}

TEST(SceneObstacles, PlanesHaveUnitNormals) {
    const Scene scene = sceneWith(R"("obstacles": [{"plane": {"point": [0, 0, 0], "normal": [0, 3, 4]}}])");
    const Shape& plane = *scene.obstacles.at(0).shape;
    EXPECT_NEAR(glm::distance(plane.normalOfHalfSpace().value(), glm::dvec3(0, 0.6, 0.8)), 0, 1e-15);
    EXPECT_EQ(scene.obstacles[0].material, 0);
    EXPECT_EQ(scene.materials[0].restitution, 0.5);
    EXPECT_EQ(refusalOf(R"("obstacles": [{"plane": {"point": [0, 0, 0], "normal": [0, 0, 0]}}])"),
              "obstacles[0].plane.normal: is (0, 0, 0), must not be zero");
}

TEST(SceneObstacles, AreChecked) {
    EXPECT_EQ(refusalOf(R"("obstacles": [{}])"),
              "obstacles[0]: has no shape, must have one of plane, box, sphere, cylinder, disc, cone, capsule, mesh, "
              "heightField");
    EXPECT_EQ(refusalOf(R"("obstacles": [{"box": {"min": [0,0,0], "max": [1,1,0]}}])"),
              "obstacles[0].box.max[2]: is 0, must be above min, which is 0");
    EXPECT_EQ(refusalOf(R"("obstacles": [{"box": {"min": [0,0,0], "max": [1,1,1]}, "material": "ice"}])"),
              R"(obstacles[0].material: is "ice", which is no material of the scene; it has none with a name)");
    EXPECT_EQ(refusalOf(R"("obstacles": [{"box": {"min": [0,0,0], "max": [1,1,1]}, "colour": "x"}])"),
              R"(obstacles[0].colour: is "x", must be #rrggbb in hexadecimal)");
}

TEST(SceneObstacles, OfEachShapeAreChecked) {
    const auto refusal = [](const std::string& obstacle) {
        std::string text = refusalOf(R"("obstacles": [{)" + obstacle + "}]");
        return text.starts_with("obstacles[0].") ? text.substr(13) : text;
    };
    const std::string ends = R"("from": [0,0,-1], "to": [0,0,-2])";
    EXPECT_EQ(refusal(R"("cone": {)" + ends + "}"), "cone.fromRadius: is 0, as `toRadius`; one must be above 0");
    EXPECT_EQ(refusal(R"("cone": {)" + ends + R"(, "fromRadius": -1})"),
              "cone.fromRadius: is -1, must be 0 to 1000000000 m");
    EXPECT_EQ(refusal(R"("cone": {"from": [0,0,1], "to": [0,0,1], "toRadius": 1})"),
              "cone.to: is (0, 0, 1), must differ from `from`");
    EXPECT_EQ(refusal(R"("cone": {)" + ends + R"(, "toRadius": 1, "open": true, "hollow": true})"),
              "cone.hollow: is true with `open`, whose both sides are free; leave one of them out");
    EXPECT_EQ(refusal(R"("cylinder": {)" + ends + R"(, "radius": 1, "open": true, "hollow": true})"),
              "cylinder.hollow: is true with `open`, whose both sides are free; leave one of them out");
    EXPECT_EQ(refusal(R"("capsule": {)" + ends + "}"), "capsule.radius: is 0, must be positive");
    EXPECT_EQ(refusal(R"("disc": {"centre": [0,0,-1], "normal": [0,0,0], "radius": 1})"),
              "disc.normal: is zero, must have a direction");
    EXPECT_EQ(refusal(R"("disc": {"centre": [0,0,-1], "normal": [0,0,1], "radius": 1, "hole": 1})"),
              "disc.hole: is 1 m, must be below the radius of 1 m");
    const std::string capsule = R"("capsule": {)" + ends + R"(, "radius": 0.1})";
    EXPECT_EQ(refusal(capsule + R"(, "rotation": {"axis": [0,0,0], "degrees": 1})"),
              "rotation.axis: is zero, must have a direction");
    EXPECT_EQ(refusal(capsule + R"(, "rotation": {"axis": [0,0,1], "degrees": 361})"),
              "rotation.degrees: is 361, must be -360 to 360°");
    EXPECT_EQ(refusal(capsule + R"(, "translation": [0,0])"), "translation: has 2 numbers, must have three: x, y, z");
    EXPECT_EQ(refusal(capsule), "accepted");
}

TEST(SceneObstacles, AloneMayBeHollow) {
    EXPECT_EQ(refusalOf(R"("sinks": [{"region": {"min": [0,0,0], "max": [1,1,1], "hollow": true}}])"),
              "sinks[0].region.hollow: is true; only the boxes of obstacles may be hollow");
}

// A plane may be far away, also if it is moved there. A box that is moved lies in coordinates of its own.
TEST(SceneObstacles, ThatAreMovedFarAreRefusedUnlessTheyArePlanes) {
    const std::string far = R"(, "translation": [0, 0, -1000]}], )" + ballAt("[0.5, 0.5, 0.5]");
    EXPECT_EQ(refusalOf(R"("obstacles": [{"plane": {"point": [0,0,0], "normal": [0,0,1]})" + far), "accepted");
    EXPECT_NE(refusalOf(R"("obstacles": [{"box": {"min": [0,0,-1], "max": [1,1,0]})" + far).find("reaches 10"),
              std::string::npos);
}

// The place of a shape is part of its distance: the box is turned onto its edge, 0.1 m above the origin.
TEST(SceneObstacles, AreTurnedAndMoved) {
    const Scene scene = sceneWith(R"("obstacles": [
        {"box": {"min": [-0.1,-0.2,-0.1], "max": [0.1,0.2,0.1]},
         "rotation": {"axis": [0,3,0], "degrees": 45}, "translation": [0.5,0.5,0.1]},
        {"plane": {"point": [0,0,0], "normal": [0,0,1]},
         "rotation": {"axis": [1,0,0], "degrees": 90}, "translation": [0,0.7,0]}])");
    const Shape& box = *scene.obstacles[0].shape;
    const double edge = 0.1 * std::sqrt(2.0);
    EXPECT_NEAR(box.distance({0.5 + edge + 0.3, 0.5, 0.1}), 0.3, 1e-12);
    EXPECT_NEAR(box.distance({0.5, 0.8, 0.1}), 0.1, 1e-12);
    EXPECT_NEAR(box.distance({0.5, 0.5, 0.1}), -0.1, 1e-12);
    const Shape& plane = *scene.obstacles[1].shape;
    EXPECT_NEAR(glm::distance(plane.normalOfHalfSpace().value(), glm::dvec3(0, -1, 0)), 0, 1e-12);
    EXPECT_NEAR(plane.distance({5, 0.5, 5}), 0.2, 1e-12);
}

TEST(SceneObstacles, HaveTheMaterialOfTheirName) {
    const Scene scene = sceneWith(R"("materials": [{}, {"name": "felt"}], "obstacles": [
        {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}, "material": "felt"},
        {"box": {"min": [0, 0, 0], "max": [0.1, 0.1, 0.1]}},
        {"box": {"min": [0, 0, 0], "max": [0.1, 0.1, 0.1]}, "material": "felt"}])");
    EXPECT_EQ(scene.obstacles[0].material, 1);
    EXPECT_EQ(scene.obstacles[1].material, 0);
    EXPECT_EQ(scene.obstacles[2].material, 1);
}

TEST(SceneObstacles, AreLimitedInNumber) {
    std::string list = R"({"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}})";
    const std::string one = list;
    for (unsigned i = 0; i < maxObstacles; ++i) list += "," + one;
    EXPECT_EQ(refusalOf("\"obstacles\": [" + list + "]"), "obstacles: has 1001 entries, must have at most 1000");
}

TEST(SceneObstacles, MayNotOverlapSpheres) {
    const std::string box = R"("obstacles": [{"plane": {"point": [0,0,0], "normal": [0,0,1]}},
                                             {"box": {"min": [0.4, 0.4, 0.4], "max": [0.6, 0.6, 0.6]}}], )";
    EXPECT_EQ(refusalOf(box + ballAt("[0.5, 0.5, 0.69]")),
              "groups[0].list.spheres[0]: is at (0.5, 0.5, 0.69) with radius 0.1 and reaches into obstacles[1]");
    EXPECT_NE(refusalOf(box + ballAt("[0.5, 0.5, 0.5]")).find("reaches into obstacles[1]"), std::string::npos);
    EXPECT_EQ(refusalOf(box + ballAt("[0.5, 0.5, 0.7]")), "accepted") << "resting on the box";
    EXPECT_EQ(refusalOf(box + ballAt("[0.66, 0.66, 0.66]")), "accepted")
        << "clear of the corner, not of its faces' planes";
    EXPECT_EQ(refusalOf(box + ballAt("[0.2, 0.2, 0.1]")), "accepted") << "resting on the plane";
}

TEST(SceneObstacles, PlaneIsSolidBehindItsSurface) {
    const std::string plane = R"("obstacles": [{"plane": {"point": [0, 0, 0.5], "normal": [0, 0, 1]}}], )";
    EXPECT_NE(refusalOf(plane + ballAt("[0.5, 0.5, 0.3]")).find("reaches into obstacles[0]"), std::string::npos);
    EXPECT_EQ(refusalOf(plane + ballAt("[0.5, 0.5, 0.6]")), "accepted");
}

}  // namespace
}  // namespace spherule::scene::testing
