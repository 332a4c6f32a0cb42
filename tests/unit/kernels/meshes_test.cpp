// Meshes in kernels, against the nearest triangle in double precision, and against the shapes that they imitate.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>

#include "compute/cpu/features.h"
#include "kernels_support.h"
#include "mesh_triangles.h"
#include "scene/mesh/mesh.h"
#include "scene/mesh/triangle_tree.h"
#include "scene/shapes.h"
#include "sim/mesh_tables.h"
#include "sim/obstacle_rows.h"

namespace spherule::kernels {
namespace {

using glm::dvec3;
using scene::Mesh;
using Feature = compute::cpu::Features;

constexpr std::size_t count = 100'000;

// Spheres of one radius around an obstacle, with the buffers of kernels.
class Around {
  public:
    Around(const scene::ShapePointer& shape, std::vector<vec4> places, double radius) : position(std::move(places)) {
        scene_.bounds = {.min = dvec3(-4), .max = dvec3(4)};
        scene_.obstacles = {{.shape = shape, .colour = ""}};
        const auto tables = sim::meshTablesFor(scene_, radius);
        const sim::ObstacleRows made(scene_, tables.get());
        for (const auto& row : made.rows()) obstacles.push_back(std::bit_cast<layout::Obstacle>(row));
        obstacleLists = {END_OF_LIST, 0, END_OF_LIST};
        obstacleLists.insert(obstacleLists.end(), tables->words.begin(), tables->words.end());
        parameters.spheres = static_cast<uint>(position.size());
        parameters.radius = static_cast<float>(radius);
        parameters.obstacles = 1;
        parameters.materials = 1;
        parameters.meshWords = static_cast<uint>(tables->words.size());
        parameters.obstacleListWords = static_cast<uint>(obstacleLists.size());
        velocity.assign(position.size(), vec4(0, 0, 0, 1));
        spin.assign(position.size(), vec4(0));
        ids.resize(position.size());
        touching.resize(position.size());
        deepest.resize(position.size());
        nearObstacles.resize(position.size());
        wallWork.resize(position.size());
    }

    void run(std::string_view kernel, std::uint64_t more = 0) {
        launch(kernel,
               {{"position", position},
                {"velocity", velocity},
                {"angularVelocity", spin},
                {"listReference", spin},
                {"idAndMaterial", ids},
                {"counters", counters},
                {"moverSlots", counters},
                {"surfaceSums", one},
                {"obstacles", obstacles},
                {"obstacleLists", obstacleLists},
                {"nearObstacles", nearObstacles},
                {"contactParams", contactParams},
                {"wallWork", wallWork},
                {"touching", touching},
                {"deepest", deepest}},
               {.parameters = &parameters,
                .features = Feature::OBSTACLES | Feature::FRAMES | Feature::BOXES | Feature::MESHES | more});
    }

    std::vector<vec4> position, velocity, spin;
    std::vector<uint> ids, touching, deepest, counters = std::vector<uint>(COUNTER_WORDS), one{0}, obstacleLists;
    std::vector<uvec2> nearObstacles;
    std::vector<float> wallWork;
    std::vector<layout::Obstacle> obstacles;
    std::vector<layout::ContactParams> contactParams = std::vector<layout::ContactParams>(1);
    layout::Parameters parameters{};

  private:
    scene::Scene scene_;
};

std::vector<vec4> placesIn(const dvec3& half, unsigned seed) {
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<vec4> places;
    for (std::size_t k = 0; k < count; ++k)
        places.emplace_back(glm::vec3(half * dvec3(uniform(engine), uniform(engine), uniform(engine))), 0);
    return places;
}

struct Case {
    const char* name;
    scene::Triangles triangles;
    Mesh::Form form;
    bool convex = false;
};

std::vector<Case> cases() {
    const scene::Triangles ball = support::bumpyBall(0.6, 0.15, 3);
    return {{"ball", ball, Mesh::Form::Solid},
            {"hollow ball", ball, Mesh::Form::Hollow},
            {"thin ball", ball, Mesh::Form::Sheet},
            {"box", support::boxOf(dvec3(-0.6, -0.5, -0.3), dvec3(0.5, 0.5, 0.5)), Mesh::Form::Solid, true},
            {"blade", support::boxOf(dvec3(-0.6, -0.5, -0.005), dvec3(0.5, 0.5, 0.005)), Mesh::Form::Solid, true},
            {"cone", support::lathe({{0, -0.5}, {0.6, -0.5}, {0, 0.6}}, 31), Mesh::Form::Solid, true},
            {"sheet", support::randomSheet({-0.7, -0.7}, {0.7, 0.7}, 12, 12, 4, 0.2), Mesh::Form::Sheet}};
}

// The deepest contact is the one with the nearest triangle. A centre in a convex solid leaves it through the nearest
// side, unless it is deeper than a radius.
TEST(KernelsAsCpp, FindTheNearestTriangleOfAMesh) {
    constexpr double radius = 0.08;
    for (const auto& [name, triangles, form, convex] : cases()) {
        const auto shape = scene::placedShape(scene::meshShape(triangles, form), {{1, 2, 3}, 40}, {0.1, -0.2, 0.3});
        Around around(shape, placesIn(dvec3(1), 5), radius);
        around.run("figures_surfaces");
        double worst = 0;
        unsigned near = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const double distance = shape->distance(dvec3(glm::vec3(around.position[k])));
            if (distance < (convex ? -radius : 0)) continue;
            const double depth = static_cast<double>(std::bit_cast<float>(around.deepest[k])) * radius;
            if (distance < radius) ++near;
            worst = std::max(worst, std::abs(depth - std::max(0.0, radius - distance)));
        }
        EXPECT_LT(worst, 1e-6) << name;
        EXPECT_GT(near, count / 100) << name;
    }
}

// Returns how many local minima the distance from `point` to the mesh has that are below `reach` (m). A point of the
// mesh is one if it is the nearest point of all triangles that contain it. `exact`: false if rounding could change the
// number.
unsigned minimaOf(const Mesh& mesh, const dvec3& point, double reach, bool& exact) {
    constexpr double same = 1e-9;
    struct Near {
        std::uint32_t triangle;
        dvec3 place;
    };
    const auto nearestIn = [&](std::uint32_t t, const dvec3& of) {
        return scene::nearestOn(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), of);
    };
    std::vector<Near> all;
    for (std::uint32_t t = 0; t < mesh.corners.size(); ++t) {
        const dvec3 place = nearestIn(t, point);
        if (glm::distance(place, point) < 1.001 * reach) all.push_back({t, place});
    }
    std::vector<dvec3> minima;
    for (const Near& one : all) {
        const bool isMinimum = std::ranges::all_of(all, [&](const Near& other) {
            return glm::distance(one.place, other.place) < same ||
                   glm::distance(one.place, nearestIn(other.triangle, one.place)) > same;
        });
        if (!isMinimum ||
            std::ranges::any_of(minima, [&](const dvec3& m) { return glm::distance(m, one.place) < same; }))
            continue;
        if (std::abs(glm::distance(one.place, point) - reach) < 1e-5 * reach) exact = false;
        if (glm::distance(one.place, point) < reach) minima.push_back(one.place);
    }
    return static_cast<unsigned>(minima.size());
}

// Expects that spheres touch the mesh at every local minimum of the distance, and nowhere else. Returns the number of
// contacts.
unsigned touchEveryMinimum(const scene::ShapePointer& shape, const std::vector<vec4>& places, double radius) {
    constexpr double skin = 2e-4;  // radii: contacts that do not quite touch count too
    Around around(shape, places, radius);
    around.run("figures_surfaces");
    unsigned wrong = 0;
    unsigned compared = 0;
    unsigned contacts = 0;
    const Mesh& mesh = *shape->mesh();
    for (std::size_t k = 0; k < places.size(); ++k) {
        bool exact = true;
        const dvec3 point = dvec3(glm::vec3(places[k])) - mesh.centre;
        const unsigned minima = minimaOf(mesh, point, radius * (1 + skin), exact);
        if (!exact) continue;
        ++compared;
        contacts += minima;
        if (around.touching[k] != minima) ++wrong;
    }
    EXPECT_EQ(wrong, 0U) << "of " << compared << " spheres with " << contacts << " contacts";
    EXPECT_GT(compared, places.size() * 9 / 10);
    return contacts;
}

// Returns `most` places at which spheres overlap the mesh, with their centres outside of a solid.
std::vector<vec4> placesAt(const scene::ShapePointer& shape, std::vector<vec4> places, double radius,
                           std::size_t most) {
    std::erase_if(places, [&](const vec4& place) {
        const double distance = shape->distance(dvec3(glm::vec3(place)));
        return distance < 0 || distance > radius;
    });
    EXPECT_GE(places.size(), most);
    places.resize(most);
    return places;
}

// Where triangles are small for a sphere, it touches the mesh at several places at once.
TEST(KernelsAsCpp, TouchAMeshAtEveryMinimumOfTheDistance) {
    unsigned seed = 11;
    for (const double bump : {0.02, 0.2})
        for (const auto form : {Mesh::Form::Solid, Mesh::Form::Sheet}) {
            const auto shape = scene::meshShape(support::bumpyBall(0.5, bump, 4), form);
            const auto places = placesAt(shape, placesIn(dvec3(0.8), seed++), 0.1, 3'000);
            EXPECT_GT(touchEveryMinimum(shape, places, 0.1), places.size());
        }
}

// A needle joins the patch of a neighbour. By rounding, its third corner may be above that neighbour, or beyond an end
// of the edge that they share.
TEST(KernelsAsCpp, TouchTheEdgesOfANeedle) {
    for (const dvec3& tip : {dvec3(-0.49999, 1e-7, -1e-7), dvec3(0.2, -1e-7, 1e-7), dvec3(-0.5, -2e-6, 0)}) {
        scene::Triangles triangles;
        triangles.vertices = {{-0.5, 0, 0}, {0.5, 0, 0}, tip, {0, 0.5, 0}};
        triangles.corners = {{0, 1, 3}, {1, 0, 2}};
        const auto shape = scene::meshShape(triangles, Mesh::Form::Sheet);
        ASSERT_TRUE(shape);
        ASSERT_EQ(shape->mesh()->corners.size(), 2U);
        std::vector<vec4> places;
        for (int k = 0; k < 200; ++k) {
            const float angle = 3.3F + 0.01F * static_cast<float>(k % 100);
            const float distance = k < 100 ? 0.000995F : 0.0005F;
            const float x = -0.45F + 0.0045F * static_cast<float>(k);  // along the edge
            places.emplace_back(x, distance * std::cos(angle), distance * std::sin(angle), 0);
        }
        Around around(shape, places, 0.001);
        around.run("figures_surfaces");
        EXPECT_EQ(std::ranges::count(around.touching, 0U), 0);
    }
}

// A hollow box of 12 triangles is the bounds: it pushes spheres to the same places as the box without triangles does.
TEST(KernelsAsCpp, MeetABoxOfTrianglesAsABox) {
    constexpr double radius = 0.05;
    const dvec3 low(-0.9, -0.7, -0.5);
    const dvec3 high(0.8, 0.7, 0.6);
    for (const bool hollow : {true, false}) {
        const auto form = hollow ? Mesh::Form::Hollow : Mesh::Form::Solid;
        Around mesh(scene::meshShape(support::boxOf(low, high), form), placesIn({0.95, 0.75, 0.65}, 6), radius);
        Around box(scene::boxShape({low, high}, hollow), mesh.position, radius);
        const std::vector<vec4> before = mesh.position;
        for (Around* one : {&mesh, &box}) {
            one->run("figures_surfaces");
            one->run("walls_impulses");
        }
        double worst = 0;
        unsigned contacts = 0;
        unsigned different = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const dvec3 place(glm::vec3(mesh.position[k]));
            // A hollow mesh has no triangles beyond its corners. Close to an edge, the direction from it is not exact.
            const dvec3 start(glm::vec3(before[k]));
            const dvec3 beyond = glm::max(low - start, start - high);
            if (hollow && std::max({beyond.x, beyond.y, beyond.z}) > 0) continue;
            const double deepest = static_cast<double>(std::bit_cast<float>(box.deepest[k]));
            if (!hollow && deepest > 0.8) continue;
            contacts += mesh.touching[k];
            if (mesh.touching[k] != box.touching[k]) ++different;
            worst = std::max(worst, glm::distance(place, dvec3(glm::vec3(box.position[k]))));
        }
        EXPECT_EQ(different, 0U) << hollow;
        EXPECT_LT(worst, 1e-6) << hollow;
        EXPECT_GT(contacts, count / 20) << hollow;
    }
}

// Lists leave a mesh out only where it is further away than the room that they note.
TEST(KernelsAsCpp, ListsKnowALowerLimitOfTheDistanceToAMesh) {
    const auto shape = scene::meshShape(support::bumpyBall(0.6, 0.15, 3), Mesh::Form::Solid);
    Around around(shape, placesIn(dvec3(3), 7), 0.02);
    around.obstacleLists.resize(around.obstacleLists.size() + 3 * count);
    around.parameters.obstacleListWords = static_cast<uint>(around.obstacleLists.size());
    around.run("list_obstacles");
    double tightest = 0;
    double shares = 0;
    unsigned left = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double distance = shape->distance(dvec3(glm::vec3(around.position[k])));
        if (around.nearObstacles[k].x != NO_OBSTACLES) continue;
        const double room = static_cast<double>(std::bit_cast<float>(around.nearObstacles[k].y)) + 0.02;
        EXPECT_LE(room, std::abs(distance) + 1e-6);
        tightest = std::max(tightest, room / std::abs(distance));
        shares += room / std::abs(distance);
        ++left;
    }
    EXPECT_GT(tightest, 0.9);
    EXPECT_GT(shares / left, 0.7);
    EXPECT_GT(left, count / 2);
}

// Over inner edges of a patch there is exactly one contact, also above vertices.
TEST(KernelsAsCpp, HaveOneContactWithAPlaneOfManyTriangles) {
    const scene::Triangles sheet = support::randomSheet({-1, -1}, {1, 1}, 20, 20, 8);
    std::vector<vec4> places = placesIn({0.9, 0.9, 0.04}, 9);
    for (std::size_t k = 0; k < sheet.vertices.size() && k < count; ++k)
        if (std::abs(sheet.vertices[k].x) < 0.9 && std::abs(sheet.vertices[k].y) < 0.9)
            places[k] = vec4(glm::vec3(sheet.vertices[k]), 0) + vec4(0, 0, 0.03F, 0);
    Around around(scene::meshShape(sheet, Mesh::Form::Sheet), places, 0.05);
    around.run("figures_surfaces");
    unsigned wrong = 0;
    for (const uint touched : around.touching)
        if (touched != 1) ++wrong;
    EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace spherule::kernels
