// Fills that are packed by relaxation: no overlaps, for any radii and regions, beside obstacles and earlier spheres.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/packing.h"
#include "scene/random.h"
#include "scene/surroundings.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

const std::string unitBox = R"("min": [0, 0, 0], "max": [1, 1, 1])";

std::string packed(const std::string& region, double fraction, const std::string& radius, std::uint64_t seed = 1) {
    return group(
        fmt::format(R"("fill": {{{}, "fraction": {}, "seed": {}}}, "radius": {})", region, fraction, seed, radius));
}

Scene built(const v1::Scene& message) {
    auto scene = build(message);
    EXPECT_TRUE(scene) << scene.error().text();
    return scene ? *scene : Scene();
}

double volumeOf(const std::vector<Sphere>& spheres) {
    double sum = 0;
    for (const Sphere& s : spheres) sum += 4 * std::numbers::pi / 3 * std::pow(static_cast<double>(s.radius), 3);
    return sum;
}

// Returns the largest overlap of two spheres, as a share of the smaller radius. `periods`: m; 0: none.
double largestOverlap(const std::vector<Sphere>& spheres, const glm::dvec3& periods = {}) {
    double largest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < spheres.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            glm::dvec3 d = spheres[i].position - spheres[j].position;
            for (int axis = 0; axis < 3; ++axis)
                if (periods[axis] > 0) d[axis] -= periods[axis] * std::round(d[axis] / periods[axis]);
            const auto a = static_cast<double>(spheres[i].radius);
            const auto b = static_cast<double>(spheres[j].radius);
            largest = std::max(largest, (a + b - glm::length(d)) / std::min(a, b));
        }
    return largest;
}

struct Radii {
    const char* name;
    const char* json;
};

class PackedRadii : public ::testing::TestWithParam<Radii> {};

// No overlaps between walls and in a periodic cell, for several seeds, well beyond what random places reach.
TEST_P(PackedRadii, HaveNoOverlaps) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
        for (const bool periodic : {false, true}) {
            const double fraction = periodic ? 0.61 : 0.54;  // spheres are sparse at walls
            v1::Scene message = parsed(object(R"("bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}, )" +
                                              packed(unitBox, fraction, GetParam().json, seed)));
            if (periodic)
                for (const v1::Axis axis : {v1::X, v1::Y, v1::Z}) message.mutable_bounds()->add_periodic(axis);
            const Scene scene = built(message);
            ASSERT_GT(scene.spheres.size(), 100U) << seed;
            const double largest = 4 * std::numbers::pi / 3 * std::pow(0.1, 3);
            EXPECT_NEAR(volumeOf(scene.spheres), fraction, largest) << seed;
            EXPECT_GE(volumeOf(scene.spheres), fraction) << seed;
            EXPECT_LE(largestOverlap(scene.spheres, glm::dvec3(periodic ? 1 : 0)), 0) << seed << ' ' << periodic;
            for (const Sphere& s : scene.spheres)
                EXPECT_FALSE(whyOutside(scene.bounds, s.position, static_cast<double>(s.radius)));
        }
}

INSTANTIATE_TEST_SUITE_P(
    Of, PackedRadii,
    ::testing::Values(
        Radii{"Equal", R"({"constant": 0.05})"}, Radii{"Uniform", R"({"uniform": {"min": 0.03, "max": 0.07}})"},
        Radii{"LogNormal", R"({"logNormal": {"median": 0.045, "deviation": 0.3, "min": 0.02, "max": 0.1}})"},
        Radii{"OneToTwo",
              R"({"table": {"radii": [0.0349, 0.035, 0.0699, 0.07], "shares": [0, 0.5, 0.5, 1], "byMass": true}})"}),
    [](const auto& parameter) { return parameter.param.name; });

// A box as triangles.
std::string boxMesh(const glm::dvec3& low, const glm::dvec3& high) {
    std::string text;
    for (int k = 0; k < 8; ++k)
        text += fmt::format("v {} {} {}\n", (k & 1) != 0 ? high.x : low.x, (k & 2) != 0 ? high.y : low.y,
                            (k & 4) != 0 ? high.z : low.z);
    for (const char* const face : {"1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"})
        text += fmt::format("f {}\n", face);
    return text;
}

struct Inside {
    const char* name;
    std::string region;
    std::string mesh;                                   // its text; empty: none
    double volume;                                      // m^3
    std::function<double(const glm::dvec3&)> distance;  // of a point inside from the surface
};

class PackedRegion : public ::testing::TestWithParam<Inside> {};

TEST_P(PackedRegion, HoldsSpheresAsAWhole) {
    const Inside& inside = GetParam();
    v1::Scene message = parsed(object(R"("bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}, )" +
                                      packed(inside.region, 0.5, R"({"uniform": {"min": 0.03, "max": 0.05}})")));
    if (!inside.mesh.empty()) message.mutable_groups(0)->mutable_fill()->mutable_in_mesh()->set_data(inside.mesh);
    const Scene scene = built(message);
    ASSERT_GT(scene.spheres.size(), 50U);
    EXPECT_NEAR(volumeOf(scene.spheres) / inside.volume, 0.5, 0.01);
    EXPECT_LE(largestOverlap(scene.spheres), 0);
    for (const Sphere& s : scene.spheres)
        EXPECT_GE(inside.distance(s.position), static_cast<double>(s.radius) * (1 - 1e-9)) << inside.name;
}

const double turned = std::numbers::pi / 6;
INSTANTIATE_TEST_SUITE_P(
    Of, PackedRegion,
    ::testing::Values(
        Inside{"Ball", R"("inSphere": {"centre": [0.5, 0.5, 0.5], "radius": 0.5})", "", std::numbers::pi / 6,
               [](const glm::dvec3& x) { return 0.5 - glm::distance(x, glm::dvec3(0.5)); }},
        Inside{"Cylinder", R"("inCylinder": {"from": [0.5, 0.5, 0.1], "to": [0.5, 0.5, 0.9], "radius": 0.45})", "",
               std::numbers::pi * 0.45 * 0.45 * 0.8,
               [](const glm::dvec3& x) {
                   return std::min({x.z - 0.1, 0.9 - x.z, 0.45 - std::hypot(x.x - 0.5, x.y - 0.5)});
               }},
        Inside{"TurnedMesh",
               R"("inMesh": {}, "translation": [0.5, 0.5, 0.5], "rotation": {"axis": [0, 0, 1], "degrees": 30})",
               boxMesh({-0.3, -0.3, -0.45}, {0.3, 0.3, 0.45}), 0.6 * 0.6 * 0.9,
               [](const glm::dvec3& x) {
                   const glm::dvec3 p = x - 0.5;
                   const glm::dvec3 own(std::cos(turned) * p.x + std::sin(turned) * p.y,
                                        -std::sin(turned) * p.x + std::cos(turned) * p.y, p.z);
                   const glm::dvec3 room = glm::dvec3(0.3, 0.3, 0.45) - glm::abs(own);
                   return std::min({room.x, room.y, room.z});
               }}),
    [](const auto& parameter) { return parameter.param.name; });

// One giant sphere that was there before, and an obstacle.
TEST(ScenePacking, AvoidsWhatIsThere) {
    const Scene scene = sceneWith(R"("obstacles": [{"sphere": {"centre": [0.8, 0.8, 0.8], "radius": 0.3}}],
        "groups": [{"list": {"spheres": [{"position": [0.35, 0.35, 0.35], "radius": 0.3}]}},
                   {"fill": {"min": [0, 0, 0], "max": [1, 1, 1], "fraction": 0.42}, "radius": {"constant": 0.03}}])");
    ASSERT_GT(scene.spheres.size(), 3000U);
    EXPECT_EQ(scene.spheres[0].position, glm::dvec3(0.35)) << "it stays where it is";
    EXPECT_LE(largestOverlap(scene.spheres), 0);
    for (const Sphere& s : scene.spheres) EXPECT_FALSE(obstacleAt(scene, s.position, static_cast<double>(s.radius)));
}

TEST(ScenePacking, PacksOneGiantAmongSmallOnes) {
    const Scene scene =
        sceneWith(packed(unitBox, 0.5, R"({"table": {"radii": [0.0299, 0.03, 0.299, 0.3], "shares": [0, 0.7, 0.7, 1],
            "byMass": true}})",
                         3));
    EXPECT_LE(largestOverlap(scene.spheres), 0);
    EXPECT_GE(volumeOf(scene.spheres), 0.5);
}

TEST(ScenePacking, DependsOnTheSeedAlone) {
    const auto placesOf = [](std::uint64_t seed) {
        std::vector<glm::dvec3> places;
        for (const Sphere& s : sceneWith(packed(unitBox, 0.5, R"({"constant": 0.06})", seed)).spheres)
            places.push_back(s.position);
        return places;
    };
    EXPECT_EQ(placesOf(1), placesOf(1));
    EXPECT_NE(placesOf(1), placesOf(2));
}

// Spheres that jam are refused, with a fraction that can be reached.
TEST(ScenePacking, SaysWhatCanBeReached) {
    const auto refused = builtWith(packed(unitBox, 0.63, R"({"constant": 0.05})"));
    ASSERT_FALSE(refused);
    const Error& error = refused.error();
    EXPECT_EQ(error.where, "groups[0].fill.fraction");
    EXPECT_EQ(error.cause, Cause::NoRoom);
    EXPECT_NE(error.text().find("they jammed at about 0.5"), std::string::npos) << error.text();
    ASSERT_TRUE(error.limits.most);
    EXPECT_GT(*error.limits.most, 0.52);
    EXPECT_LT(*error.limits.most, 0.63);
    // The share is of all radii at once; the same places are not found again at exactly this fraction.
    const Scene scene = sceneWith(packed(unitBox, *error.limits.most - 0.015, R"({"constant": 0.05})"));
    EXPECT_LE(largestOverlap(scene.spheres), 0);
}

TEST(ScenePacking, RefusesAtOnceWhatNoPackingReaches) {
    EXPECT_EQ(refusalOf(packed(unitBox, 0.7, R"({"constant": 0.004})")),
              "groups[0].fill.fraction: asks for 2611136 spheres in 0.7 of the volume of the region, but spheres of "
              "these radii jam at about 0.634; ask for less, or make the region larger");
}

TEST(ScenePacking, CanBeCancelled) {
    Progress progress;
    progress.cancel();
    Check check(&progress);
    std::vector<PackedSphere> spheres;
    Random random(1);
    for (int k = 0; k < 500; ++k)
        spheres.push_back({.centre = placeIn(Box{glm::dvec3(0), glm::dvec3(1)}, random), .radius = 0.06});
    EXPECT_FALSE(pack(check, spheres, {.box = {glm::dvec3(0), glm::dvec3(1)}}).packed);
    EXPECT_FALSE(check.ok());
}

TEST(ScenePacking, KnowsTheClosestPackingOfEqualSpheresAndMixtures) {
    std::vector<PackedSphere> spheres(1000, {.radius = 1});
    EXPECT_DOUBLE_EQ(closestPacking(spheres), 0.634);
    // Half of them 1.4 times as large: a deviation of 1/6 without skewness.
    for (std::size_t k = 0; k < spheres.size(); k += 2) spheres[k].radius = 1.4;
    EXPECT_NEAR(closestPacking(spheres), 0.634 + 0.0658 / 6, 1e-12);
}

TEST(ScenePacking, RefusesWrongRegions) {
    const std::string radius = R"({"constant": 0.05})";
    EXPECT_EQ(
        refusalOf(packed(R"("min": [0, 0, 0], "inSphere": {"centre": [0.5, 0.5, 0.5], "radius": 0.4})", 0.3, radius)),
        "groups[0].fill.min: is given with another region; leave one of them out");
    EXPECT_EQ(refusalOf(packed(R"("inSphere": {"centre": [0.5, 0.5, 0.5], "radius": 0.6})", 0.3, radius)),
              "groups[0].fill: reaches x = -0.1, outside the bounds, which are 0 to 1; make the region smaller, or the "
              "bounds larger");
    EXPECT_EQ(refusalOf(packed(unitBox + R"(, "translation": [0, 0, 1])", 0.3, radius)),
              "groups[0].fill.translation: is given without `inMesh`; leave it out");
    EXPECT_EQ(refusalOf(packed(unitBox, 1.5, radius)), "groups[0].fill.fraction: is 1.5, must be at most 1");
    v1::Scene sheet =
        parsed(object(R"("bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}, )" + packed(R"("inMesh": {})", 0.3, radius)));
    sheet.mutable_groups(0)->mutable_fill()->mutable_in_mesh()->set_data("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto open = build(sheet);
    ASSERT_FALSE(open) << "an open sheet has no inside";
    EXPECT_EQ(open.error().where, "groups[0].fill.inMesh.data");
}

}  // namespace
}  // namespace spherule::scene::testing
