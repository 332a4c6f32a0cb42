// The triangles of obstacles are their surface, seen from the free space.
#include "scene/tessellation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "scene/check.h"
#include "scene/json.h"
#include "scene/shapes.h"
#include "spherule/v1/facts.pb.h"

namespace spherule::scene {
namespace {

constexpr double pi = std::numbers::pi;
const Box bounds{{-4, -4, -4}, {4, 4, 4}};

v1::Obstacle obstacleOf(const std::string& json) {
    const auto scene = parseJson("{\"obstacles\": [" + json + "]}", "scene");
    EXPECT_TRUE(scene) << scene.error().text();
    return scene->obstacles(0);
}

glm::dvec3 areaOf(const Tessellation& surface, const glm::uvec3& each) {
    const glm::dvec3 a = surface.points[each.x];
    return 0.5 * glm::cross(surface.points[each.y] - a, surface.points[each.z] - a);
}

double areaOf(const Tessellation& surface) {
    double area = 0;
    for (const glm::uvec3& each : surface.corners) area += glm::length(areaOf(surface, each));
    return area;
}

// Returns the volume that a closed surface encloses, negative if the triangles face inwards.
double volumeOf(const Tessellation& surface) {
    double volume = 0;
    for (const glm::uvec3& each : surface.corners)
        volume += glm::dot(surface.points[each.x], areaOf(surface, each)) / 3;
    return volume;
}

constexpr double roundness = 0.005;  // of areas and volumes with 64 sides

TEST(Tessellation, EncloseTheSolid) {
    const double slant = std::hypot(0.5, 2);
    const struct {
        std::string shape;
        double volume, area;
    } cases[] = {
        {R"("box": {"min": [1, 1, 1], "max": [2, 3, 4]%s})", 6, 22},
        {R"("sphere": {"centre": [1, 2, 3], "radius": 0.5%s})", pi / 6, pi},
        {R"("cylinder": {"from": [1, 0, 0], "to": [1, 3, 4], "radius": 0.5%s})", 1.25 * pi, 5.5 * pi},
        {R"("cone": {"from": [0, 0, 0], "to": [0, 0, 2], "fromRadius": 1, "toRadius": 0.5%s})", pi * 2 / 3 * 1.75,
         pi * (1.25 + 1.5 * slant)},
        {R"("capsule": {"from": [0, 0, 0], "to": [2, 0, 0], "radius": 0.5%s})", pi * (0.5 + 1. / 6), 3 * pi},
    };
    for (const auto& each : cases) {
        for (const bool hollow : {false, true}) {
            std::string shape = each.shape;
            shape.replace(shape.find("%s"), 2, hollow ? R"(, "hollow": true)" : "");
            const Tessellation surface = tessellationOf(
                obstacleOf("{" + shape +
                           R"(, "rotation": {"axis": [1, 2, 3], "degrees": 50}, "translation": [1, 2, 3]})"),
                nullptr, {glm::mat3_cast(glm::angleAxis(0.7, glm::dvec3(0, 0.6, 0.8))), {3, 2, 1}}, bounds);
            EXPECT_NEAR(volumeOf(surface), hollow ? -each.volume : each.volume, roundness * each.volume) << shape;
            EXPECT_NEAR(areaOf(surface), each.area, roundness * each.area) << shape;
        }
    }
}

TEST(Tessellation, LieOnTheSurface) {
    for (const std::string shape :
         {R"("box": {"min": [1, 1, 1], "max": [2, 3, 4]})",
          R"("disc": {"centre": [1, 2, 0], "normal": [0, 1, 2], "radius": 1})",
          R"("disc": {"centre": [1, 2, 0], "normal": [0, 1, 2], "radius": 1, "hole": 0.4})",
          R"("cylinder": {"from": [1, 0, 0], "to": [1, 3, 1], "radius": 0.5, "open": true})",
          R"("cone": {"from": [1, 0, 0], "to": [1, 3, 1], "fromRadius": 0, "toRadius": 0.5, "open": true})",
          R"("plane": {"point": [0, 0, 1], "normal": [1, 1, 3]})",
          R"("capsule": {"from": [1, 0, 0], "to": [1, 3, 1], "radius": 0.5})"}) {
        const v1::Obstacle obstacle = obstacleOf(
            "{" + shape + R"(, "rotation": {"axis": [1, 2, 3], "degrees": 50}, "translation": [0.1, 0.2, 0.3]})");
        Check check;
        const ShapePointer read = readShape(check, obstacle, "");
        const Frame pose{glm::mat3_cast(glm::angleAxis(0.3, glm::dvec3(0, 0.6, 0.8))), {0.3, -0.2, 0.1}};
        const Tessellation surface = tessellationOf(obstacle, nullptr, pose, bounds);
        EXPECT_GE(surface.corners.size(), 2U) << shape;
        for (const glm::dvec3& point : surface.points)
            EXPECT_NEAR(read->distance(pose.inside(point)), 0, 1e-9) << shape;
    }
}

TEST(Tessellation, OfAPlaneEndAtTheBoundsWhereverItMoves) {
    const v1::Obstacle plane = obstacleOf(R"({"plane": {"point": [0, 0, 1], "normal": [0, 0, 2]}})");
    const Tessellation level = tessellationOf(plane, nullptr, {.origin = {100, 0, 2}}, bounds);
    EXPECT_NEAR(areaOf(level), 64, 1e-9);
    EXPECT_NEAR(areaOf(level, level.corners.front()).x, 0, 1e-9);
    EXPECT_GT(areaOf(level, level.corners.front()).z, 0) << "it faces the free space";
    EXPECT_EQ(level.points.front().z, 3);
    EXPECT_TRUE(tessellationOf(plane, nullptr, {.origin = {0, 0, 4}}, bounds).corners.empty());
}

// A mesh has its triangles, turned and moved with the obstacle. Without them, it is their box.
TEST(Tessellation, OfAMeshAreItsTriangles) {
    const v1::Obstacle obstacle = obstacleOf(
        R"({"mesh": {"solid": true}, "rotation": {"axis": [0, 0, 1], "degrees": 90}, "translation": [1, 2, 3]})");
    v1::MeshFacts mesh;
    for (const double value : {-0.5, 0., 0.}) mesh.add_min(value);
    for (const double value : {1., 2., 3.}) mesh.add_max(value);
    EXPECT_NEAR(volumeOf(tessellationOf(obstacle, &mesh, {}, bounds)), 9, 1e-9);
    const std::vector<glm::vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {-0.5, 0, 0}};
    std::vector<glm::uvec3> triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const auto fill = [&] {
        mesh.set_vertices(vertices.data(), vertices.size() * sizeof vertices[0]);
        mesh.set_indices(triangles.data(), triangles.size() * sizeof triangles[0]);
    };
    fill();
    const Tessellation surface = tessellationOf(obstacle, &mesh, {.origin = {0, 0, 1}}, bounds);
    EXPECT_EQ(surface.points.size(), 5U);
    EXPECT_NEAR(volumeOf(surface), 1, 1e-9);
    EXPECT_NEAR(glm::distance(surface.points[2], {-1, 2, 4}), 0, 1e-9);
    triangles[3].z = 5;
    fill();
    EXPECT_TRUE(tessellationOf(obstacle, &mesh, {}, bounds).corners.empty()) << "there is no vertex 5";
}

TEST(Tessellation, AreNoneOfAnObstacleThatScenesCannotHave) {
    EXPECT_TRUE(tessellationOf({}, nullptr, {}, bounds).points.empty());
    EXPECT_TRUE(tessellationOf(obstacleOf(R"({"sphere": {"centre": [0, 0], "radius": 1}})"), nullptr, {}, bounds)
                    .points.empty());
    EXPECT_TRUE(tessellationOf(obstacleOf(R"({"sphere": {"centre": [0, 0, 0], "radius": -1}})"), nullptr, {}, bounds)
                    .points.empty());
}

}  // namespace
}  // namespace spherule::scene
