// Obstacles of triangles in each model: rolling over inner edges, tipping over an edge, rebounds, and no sphere lost.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "mesh_support.h"
#include "scene/quality.h"
#include "scene/random.h"
#include "scene/shapes.h"

namespace spherule::physics {
namespace {

using scene::Mesh;
using support::boxOf;
using support::lathe;
using support::randomSheet;

constexpr double radius = 0.05;  // m

class Meshes : public testing::TestWithParam<scene::Model> {};

struct Motion {
    glm::dvec3 x{};
    glm::dvec3 v{};
};

Motion motionOf(sim::Simulation& simulation) {
    const sim::State state = simulation.snapshot();
    return {placeOf(state, simulation.scene()), velocityOf(state, 0)};
}

scene::Scene rolling(scene::Model model, bool mesh) {
    scene::Scene scene = spaceFor(model, 24);
    scene.forces.gravity = {0, 0, -earth};
    measure::setFriction(scene, 0.5);
    setRestitution(scene, 0);
    scene::Triangles sheet = randomSheet({-6, -1.5}, {6, 1.5}, 40, 10, 17);
    scene.obstacles.push_back(mesh ? meshOf(sheet, Mesh::Form::Sheet)
                                   : scene::Obstacle{.shape = scene::planeShape({}, {0, 0, 1}), .colour = ""});
    // `accurate` begins at the depth at which it floats.
    scene::Sphere& sphere = measure::addSphere(scene, {-5, 0.013, radius}, radius, {2, 0, 0});
    sphere.spin = {0, static_cast<float>(2 / radius), 0};
    return scene;
}

// 10 m over 800 triangles in one plane, against one plane.
TEST_P(Meshes, HaveNoBumpsInAPlane) {
    const auto sheet = simulate(rolling(GetParam(), true));
    const auto plane = simulate(rolling(GetParam(), false));
    double height = 0;
    for (int k = 0; k < 48; ++k) {
        for (sim::Simulation* one : {sheet.get(), plane.get()}) run(*one, 0.1);
        height = std::max(height, std::abs(motionOf(*sheet).x.z - motionOf(*plane).x.z));
    }
    const Motion onSheet = motionOf(*sheet);
    const Motion onPlane = motionOf(*plane);
    EXPECT_GT(onSheet.x.x, 4.5);
    EXPECT_LT(height, 1e-4 * radius);
    EXPECT_NEAR(onSheet.v.x / onPlane.v.x, 1, 1e-5);
    EXPECT_LT(std::abs(onSheet.x.y - onPlane.x.y), 1e-6 * 10);
    RecordProperty("height", std::to_string(height / radius * 1e9) + "e-9 r");
    RecordProperty("speed", std::to_string((onSheet.v.x / onPlane.v.x - 1) * 1e9) + "e-9");
}

// A square at z = 0 of 20,000 triangles, which are smaller than the spheres. One border is lower by `depth` (m), which
// moves the cells of the mesh.
scene::Triangles fineSheet(double depth) {
    constexpr unsigned side = 100;
    scene::Triangles sheet;
    for (unsigned row = 0; row <= side; ++row)
        for (unsigned column = 0; column <= side; ++column)
            sheet.vertices.emplace_back(0.03 * column - 1.5, 0.03 * row - 1.5, row == 0 ? -depth : 0.0);
    for (unsigned row = 0; row < side; ++row)
        for (unsigned column = 0; column < side; ++column) {
            const unsigned a = row * (side + 1) + column;
            const unsigned b = a + side + 1;
            sheet.corners.insert(sheet.corners.end(), {{a, a + 1, b + 1}, {a, b + 1, b}});
        }
    return sheet;
}

// 100 spheres that move by 0.48 radii in a substep, without losses. In `balanced`, some begin the substep in which they
// meet the sheet in a cell that has no triangle near enough for slow spheres.
std::vector<Motion> afterRebounds(scene::Model model, const scene::Obstacle& floor, std::uint64_t seed) {
    scene::Scene scene = spaceFor(model, 8);
    setRestitution(scene, 1);
    scene.step = 1.0 / 240;
    scene.quality.substeps = 1;
    scene.obstacles.push_back(floor);
    scene::Random random(seed);
    constexpr std::size_t spheres = 100;
    for (std::size_t k = 0; k < spheres; ++k) {
        const glm::dvec3 place(0.2 * static_cast<double>(k % 10) - 0.9, 0.2 * static_cast<double>(k / 10) - 0.9,
                               0.3 + 0.1 * random.uniform());
        measure::addSphere(scene, place, radius, {0.4, -0.3, -0.48 * radius / scene.step});
    }
    const auto simulation = simulate(scene);
    run(*simulation, 0.15);
    const sim::State state = simulation->snapshot();
    std::vector<Motion> motions;
    for (std::uint32_t k = 0; k < spheres; ++k)
        motions.push_back({placeOf(state, simulation->scene(), k), velocityOf(state, k)});
    return motions;
}

TEST_P(Meshes, ReboundFastSpheresAsAPlane) {
    if (GetParam() == scene::Model::Accurate) return;  // its substeps are shorter
    const scene::Obstacle plane{.shape = scene::planeShape({}, {0, 0, 1}), .colour = ""};
    for (unsigned seed = 1; seed <= 6; ++seed) {
        const scene::Obstacle sheet = meshOf(fineSheet(0.25 * seed * radius), Mesh::Form::Sheet);
        const std::vector<Motion> onMesh = afterRebounds(GetParam(), sheet, seed);
        const std::vector<Motion> onPlane = afterRebounds(GetParam(), plane, seed);
        for (std::size_t k = 0; k < onMesh.size(); ++k) {
            EXPECT_GT(onPlane[k].v.z, 5) << k;
            EXPECT_LT(glm::distance(onMesh[k].x, onPlane[k].x), 1e-4 * radius) << k;
            EXPECT_LT(glm::distance(onMesh[k].v, onPlane[k].v), 1e-5 * glm::length(onPlane[k].v)) << k;
        }
    }
}

// Returns the angle at which a sphere leaves the sharp edge on which it was at rest (degrees).
double angleOverAnEdge(scene::Model model, double friction) {
    scene::Scene scene = spaceFor(model, 8);
    scene.forces.gravity = {0, 0, -earth};
    setRestitution(scene, 0);
    measure::setFriction(scene, friction);
    scene.step = 1.0 / 4800;
    scene.quality.substeps = model == scene::Model::Accurate ? 50 : 1;
    scene.obstacles.push_back(meshOf(boxOf({-1, -1, -1}, {0, 1, 0}), Mesh::Form::Solid));
    measure::addSphere(scene, {1e-3 * radius, 0.1, radius * (1 - 1e-4)}, radius);
    const auto simulation = simulate(scene);
    // Without friction, the edge pushes with m g (3 cos - 2), which is 2 % of the weight half a degree before the end.
    // A sphere that has left is not pushed in any later step.
    constexpr int enough = 10;  // steps, 2 ms
    double left = 0;
    int free = 0;
    Motion before = motionOf(*simulation);
    for (int k = 0; k < 9600; ++k) {
        run(*simulation, scene.step);
        const Motion now = motionOf(*simulation);
        const glm::dvec3 push = (now.v - before.v) / scene.step + glm::dvec3(0, 0, earth);
        const double angle = std::atan2(now.x.x, now.x.z) * 180 / std::numbers::pi;
        free = angle > 20 && glm::length(push) < 0.01 * earth ? free + 1 : 0;
        if (free == 1) left = angle;
        if (free == enough) return left;
        before = now;
    }
    return 0;
}

// A sphere that slides leaves at the angle whose cosine is 2/3. One that rolls leaves at the angle whose cosine is
// 10/17.
TEST_P(Meshes, LetASphereTipOverAnEdge) {
    if (GetParam() == scene::Model::Fast) return;  // it has no contacts that last
    EXPECT_NEAR(angleOverAnEdge(GetParam(), 0), 48.19, 0.5);
    EXPECT_NEAR(angleOverAnEdge(GetParam(), 20), 53.97, 0.5);
}

// Drops a sphere in a drum of 64 sides, onto a side and onto an edge between two. Returns its restitution.
double restitutionIn(scene::Model model, const scene::Obstacle& drum, double angle) {
    scene::Scene scene = spaceFor(model, 8);
    setRestitution(scene, 0.6);
    scene.obstacles.push_back(drum);
    const glm::dvec3 way(std::cos(angle), std::sin(angle), 0);
    measure::addSphere(scene, 0.5 * way, radius, 2.0 * way);
    const auto simulation = simulate(scene);
    run(*simulation, 0.45);
    return -glm::dot(motionOf(*simulation).v, way) / 2;
}

TEST_P(Meshes, OfManySidesReboundAsACylinder) {
    const scene::Obstacle exact =
        obstacleFrom(R"({"cylinder":{"from":[0,0,-1],"to":[0,0,1],"radius":1,"hollow":true}})");
    const scene::Obstacle drum = meshOf(lathe({{0, -1}, {1, -1}, {1, 1}, {0, 1}}, 64), Mesh::Form::Hollow);
    const double wanted = restitutionIn(GetParam(), exact, 0.3);
    for (const double side : {0.0, 0.1, 0.25, 0.5, 0.77}) {
        const double angle = 2 * std::numbers::pi / 64 * (3 + side);
        EXPECT_NEAR(restitutionIn(GetParam(), drum, angle) / wanted, 1, 0.01) << side;
    }
}

TEST_P(Meshes, LoseNoFastSphere) {
    const bool accurate = GetParam() == scene::Model::Accurate;
    flyInBottle(GetParam(), accurate ? 0.1 : 0.5, 200, accurate ? 1000 : 50, 0.01);
}

// Returns the velocities of spheres after they have hit a groove between two planes, near its line. The angle between
// the normals of its sides is `bend` (rad). `side`: 1 if they come from the front of the triangles, else -1.
std::vector<glm::dvec3> afterGroove(bool mesh, double bend, double side, scene::Random random) {
    constexpr double speed = 30;  // m/s
    scene::Scene scene = spaceFor(scene::Model::Accurate, 8);
    scene.sphereContacts = false;
    scene.quality.substeps = 200;
    setRestitution(scene, random.uniform(0, 1) < 0.5 ? 1 : 0.4);
    measure::setFriction(scene, 0);
    const glm::dvec3 x = glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
    const glm::dvec3 y = glm::normalize(glm::cross(x, glm::dvec3(random.normal(), random.normal(), random.normal())));
    const glm::dvec3 z = glm::cross(x, y);
    const auto away = [&](double angle) { return std::cos(angle) * x + std::sin(angle) * z; };  // from the line
    const double slope = side * bend;
    const std::array normals{side * z, side * away(slope + std::numbers::pi / 2)};
    if (mesh) {
        const scene::Triangles triangles{.vertices = {-x - y, -x + y, -y, y, away(slope) - y, away(slope) + y},
                                         .corners = {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}}};
        scene.obstacles.push_back(meshOf(triangles, Mesh::Form::Sheet));
    } else {
        for (const glm::dvec3& normal : normals)
            scene.obstacles.push_back({.shape = scene::planeShape({}, normal), .colour = ""});
    }
    const glm::dvec3 middle = glm::normalize(normals[0] + normals[1]);
    while (scene.spheres.size() < 50) {
        const glm::dvec3 way =
            glm::normalize(away(random.uniform(0, 2 * std::numbers::pi)) + random.uniform(-0.5, 0.5) * y);
        // The first contact is near the line of the groove.
        const glm::dvec3 aim = radius * (middle / std::cos(bend / 2) + random.uniform(-1, 1) * glm::cross(middle, y));
        const glm::dvec3 from = aim - 0.15 * way + random.uniform(-0.4, 0.4) * y;
        if (std::ranges::any_of(normals, [&](const glm::dvec3& n) { return glm::dot(from, n) < 1.1 * radius; }))
            continue;
        measure::addSphere(scene, from, radius, speed * way);
    }
    const auto simulation = simulate(scene);
    run(*simulation, 0.02);
    const sim::State after = simulation->snapshot();
    std::vector<glm::dvec3> velocities;
    for (std::size_t k = 0; k < scene.spheres.size(); ++k) velocities.push_back(velocityOf(after, k) / speed);
    return velocities;
}

// A side ends at the line of the groove, but its spring does not, while it is compressed.
TEST(MeshesInAccurate, ActAsTwoPlanesInAGroove) {
    double largest = 0;
    for (std::uint32_t seed = 1; seed <= 24; ++seed) {
        scene::Random random(seed);
        const double bend = random.uniform(0.3, 1.5);
        const double side = seed % 2 == 0 ? 1 : -1;
        const auto planes = afterGroove(false, bend, side, random);
        const auto mesh = afterGroove(true, bend, side, random);
        for (std::size_t k = 0; k < planes.size(); ++k) {
            const double error = glm::distance(planes[k], mesh[k]);
            largest = std::max(largest, error);
            EXPECT_LT(error, 1e-3) << "seed " << seed << ", bend " << bend << ", sphere " << k;
        }
    }
    RecordProperty("largest", std::to_string(largest));
}

// A sheet holds spheres on both of its sides. It lies between z = 0 and 5 cm, and their centres keep 3 cm from it.
TEST_P(Meshes, WithoutThicknessHaveTwoSides) {
    scene::Scene scene = spaceFor(GetParam(), 4);
    setRestitution(scene, 0.5);
    scene.obstacles.push_back(meshOf(randomSheet({-1, -1}, {1, 1}, 8, 8, 5, 0.05), Mesh::Form::Sheet));
    scene::Random random(3);
    for (unsigned k = 0; k < 60; ++k) {
        const double side = k % 2 == 0 ? 1 : -1;
        measure::addSphere(scene, {random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6), 0.025 + side * 0.5}, 0.03,
                           {0, 0, -3 * side});
    }
    scene.sphereContacts = false;
    const auto simulation = simulate(scene);
    run(*simulation, 0.4);
    const sim::State state = simulation->snapshot();
    for (unsigned k = 0; k < 60; ++k) {
        const double side = k % 2 == 0 ? 1 : -1;
        EXPECT_GT((placeOf(state, scene, k).z - 0.025) * side, 0) << k;
    }
}

INSTANTIATE_TEST_SUITE_P(Of, Meshes, testing::ValuesIn(models),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

}  // namespace
}  // namespace spherule::physics
