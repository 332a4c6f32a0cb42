#include <gtest/gtest.h>

#include <algorithm>

#include <glm/geometric.hpp>

#include "scene/occupancy.h"
#include "scene/random.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

std::string textOf(const std::string& bounds, const std::string& more = "") {
    return R"({"bounds": {"min": [0, 0, 0], "max": [2, 1, 3], )" + bounds + "}" + more + "}";
}

std::string refusal(const std::string& bounds, const std::string& more = "") {
    const auto scene = build(parsed(textOf(bounds, more)));
    return scene ? "accepted" : scene.error().text();
}

Scene accepted(const std::string& bounds, const std::string& more = "") {
    auto scene = build(parsed(textOf(bounds, more)));
    EXPECT_TRUE(scene) << scene.error().text();
    return *scene;
}

TEST(ScenePeriodicAxes, AreNamed) {
    const Bounds bounds = accepted(R"("periodic": ["Z", "X"], "open": ["Y_MAX"])").bounds;
    EXPECT_EQ(bounds.periodic, (std::array{true, false, true}));
    EXPECT_EQ(bounds.periods(), glm::dvec3(2, 0, 3));
    for (std::size_t face = 0; face < 6; ++face) EXPECT_EQ(bounds.walled(face), face == YMin) << face;
    EXPECT_EQ(refusal(R"("periodic": ["X", 7])"), "bounds.periodic[1]: is 7, must be X, Y or Z");
    EXPECT_EQ(refusal(R"("periodic": ["AXIS_UNSPECIFIED"])"), "bounds.periodic[0]: is 0, must be X, Y or Z");
}

TEST(ScenePeriodicAxes, HaveNoOpenFaces) {
    EXPECT_EQ(
        refusal(R"("periodic": ["X", "Y"], "open": ["Y_MAX"])"),
        "bounds.periodic[1]: is Y, but the face Y_MAX is open; an axis is periodic, or its faces are walls or open");
}

TEST(ScenePeriodicAxes, HaveOnlyPlanesAlongThem) {
    const auto plane = [](const std::string& normal) {
        return R"(, "obstacles": [{"plane": {"point": [1, 0, 1], "normal": )" + normal + "}}]";
    };
    EXPECT_EQ(refusal(R"("periodic": ["X"])", plane("[0, 1, 1]")), "accepted");
    const std::string reason =
        "obstacles[0]: is not the same along the whole periodic axis X; with periodic axes, obstacles must be planes "
        "that "
        "are parallel to them";
    EXPECT_EQ(refusal(R"("periodic": ["X"])", plane("[0.1, 1, 1]")), reason);
    EXPECT_EQ(refusal(R"("periodic": ["X"])", R"(, "obstacles": [{"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}])"),
              reason);
}

TEST(ScenePeriodicAxes, HaveNoAttraction) {
    EXPECT_EQ(refusal(R"("periodic": ["X"])", R"(, "fields": [{"drag": {}}])"), "accepted");
    EXPECT_EQ(refusal(R"("periodic": ["X"])",
                      R"(, "fields": [{"attraction": {"centre": [1, 0, 1], "strength": 1, "softening": 0.1}}])"),
              "fields[0].attraction: has one centre, but a periodic axis would repeat it; remove one of them");
}

TEST(ScenePeriodicAxes, HaveFieldsThatAreTheSameAlongThem) {
    const auto field = [](const std::string& text) {
        return refusal(R"("periodic": ["X"])", R"(, "fields": [{)" + text + "}]");
    };
    EXPECT_EQ(field(R"("spring": {"centre": [1, 0, 1], "stiffness": 1})"),
              "fields[0].spring: has one centre, but a periodic axis would repeat it; remove one of them");
    EXPECT_EQ(field(R"("drag": {"velocity": [1, 2, 3]})"), "accepted");
    EXPECT_EQ(field(R"("drag": {"vortex": {"centre": [0, 0, 0], "axis": [-3, 0, 0], "core": 1}})"), "accepted");
    EXPECT_EQ(field(R"("drag": {"vortex": {"centre": [0, 0, 0], "axis": [3, 1, 0], "core": 1}})"),
              "fields[0].drag.vortex: has one axis, but a periodic axis would repeat it; turn the vortex along the "
              "periodic axis, or remove one of them");
    const std::string reason =
        "fields[0]: has a region that ends along the periodic axis X; with periodic axes, the region must be a box "
        "that "
        "spans the bounds along them";
    EXPECT_EQ(field(R"("drag": {}, "inSphere": {"centre": [0, 0, 0], "radius": 100})"), reason);
    EXPECT_EQ(field(R"("drag": {}, "inBox": {"min": [0.1, 0, 0], "max": [9, 1, 1]})"), reason);
    EXPECT_EQ(field(R"("drag": {}, "inBox": {"min": [-9, 0, 0], "max": [9, 1, 1]})"), "accepted");
    EXPECT_EQ(field(R"("buoyancy": {})"), "accepted");
    EXPECT_EQ(
        refusal(R"("periodic": ["X"])", R"(, "gravity": [1, 0, -9], "fields": [{"buoyancy": {}}])"),
        "fields[0].buoyancy: is of a liquid at rest, but gravity has a part along the periodic axis X, along which "
        "the liquid would flow; remove one of them");
}

TEST(ScenePeriodicAxes, ContainCentresOnly) {
    const auto ball = [](const std::string& x) {
        return R"(, "groups": [{"list": {"spheres": [{"position": [)" + x + R"(, 0.5, 1], "radius": 0.1}]}}])";
    };
    EXPECT_EQ(refusal(R"("periodic": ["X"])", ball("1.95")), "accepted");
    EXPECT_EQ(
        refusal(R"("periodic": ["X"])", ball("2.01")),
        "groups[0].list.spheres[0]: is at (2.01, 0.5, 1) with radius 0.1 and has its centre at x = 2.01, outside the "
        "bounds, which are 0 to 2");
}

// Returns how many spheres reach across a face of a periodic axis. Expects that no two overlap, images included.
int acrossSeams(const Scene& scene) {
    int across = 0;
    const glm::dvec3 periods = scene.bounds.periods();
    for (std::size_t a = 0; a < scene.spheres.size(); ++a) {
        const auto r = static_cast<double>(scene.spheres[a].radius);
        const glm::dvec3& p = scene.spheres[a].position;
        if (p.x < r || p.x > periods.x - r) ++across;
        for (std::size_t b = 0; b < a; ++b) {
            const double gap = glm::length(separation(p, scene.spheres[b].position, periods)) - r -
                               static_cast<double>(scene.spheres[b].radius);
            EXPECT_GT(gap, -1e-7) << a << " and " << b;
        }
    }
    return across;
}

TEST(ScenePeriodicAxes, AreFilledAcrossTheSeam) {
    const std::string region = R"("min": [0, 0, 0], "max": [2, 1, 3])";
    for (const std::string seed : {"1", "2", "3"})
        EXPECT_GT(acrossSeams(accepted(R"("periodic": ["X", "Z"])", R"(, "groups": [{"fill": {)" + region +
                                                                        R"(, "count": 600, "seed": )" + seed +
                                                                        R"(}, "radius": {"uniform": {"min": 0.03,
                                                                        "max": 0.09}}}])")),
                  10);
    EXPECT_EQ(acrossSeams(accepted(R"("periodic": ["X"])", R"(, "groups": [{"fill": {"min": [0.1, 0, 0],
                          "max": [2, 1, 3], "count": 300}, "radius": {"constant": 0.08}}])")),
              0)
        << "the region has not the whole length";
}

TEST(ScenePeriodicAxes, HaveLatticesAcrossTheSeam) {
    const auto lattice = [](const std::string& bounds) {
        return accepted(bounds, R"(, "groups": [{"lattice": {"min": [0, 0, 0], "max": [2, 1, 3], "spacing": 0.2,
                                "jitter": 0.04, "seed": 5}, "radius": {"constant": 0.05}}])");
    };
    const Scene periodic = lattice(R"("periodic": ["X", "Z"])");
    EXPECT_EQ(periodic.spheres.size(), 10U * 5U * 15U);
    acrossSeams(periodic);
    EXPECT_EQ(lattice(R"("open": [])").spheres.size(), 10U * 5U * 15U);
    const Scene tight =
        accepted(R"("periodic": ["X"])", R"(, "groups": [{"lattice": {"min": [0, 0, 0], "max": [2, 1, 3],
                                 "spacing": 0.25}, "radius": {"constant": 0.125}}])");
    EXPECT_EQ(tight.spheres.size(), 8U * 4U * 12U);
    acrossSeams(tight);
}

TEST(ScenePeriodicAxes, OccupancyAgreesWithBruteForce) {
    Random random(4);
    Bounds bounds{.min = {-1, -1, -1}, .max = {1, 1, 1}};
    bounds.periodic = {true, true, false};
    Occupancy occupancy(0.2, bounds);
    std::vector<std::pair<glm::dvec3, double>> taken;
    int seam = 0;
    for (int i = 0; i < 2000; ++i) {
        glm::dvec3 p{};
        for (int axis = 0; axis < 3; ++axis) p[axis] = random.uniform(-1, 1);
        const double r = i % 3 == 0 ? 0.2 : i % 3 == 1 ? 0.05 : 0.007;
        const auto meets = [&](const auto& t) {
            return glm::length(separation(t.first, p, bounds.periods())) < t.second + r;
        };
        const bool expected = std::none_of(taken.begin(), taken.end(), meets);
        ASSERT_EQ(occupancy.isFree(p, r), expected) << i;
        const auto meetsInside = [&](const auto& t) { return glm::distance(t.first, p) < t.second + r; };
        if (!expected && std::none_of(taken.begin(), taken.end(), meetsInside)) ++seam;
        if (!expected) continue;
        occupancy.add(p, r);
        taken.emplace_back(p, r);
    }
    EXPECT_GT(seam, 30);
}

}  // namespace
}  // namespace spherule::scene::testing
