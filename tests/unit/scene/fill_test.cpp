#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "scene/occupancy.h"
#include "scene/random.h"
#include "scene/surroundings.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

std::string fill(const std::string& more, const std::string& radius) {
    return group(R"("fill": {"min": [0, 0, 0], "max": [1, 1, 1], )" + more + R"(}, "radius": )" + radius);
}

std::size_t overlapsIn(const Scene& scene) {
    std::size_t count = 0;
    const auto& spheres = scene.spheres;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const double reach = static_cast<double>(spheres[i].radius) + static_cast<double>(spheres[j].radius);
            if (glm::distance(spheres[i].position, spheres[j].position) < reach) ++count;
        }
    }
    return count;
}

TEST(SceneFill, PlacesAllSpheresWithoutOverlaps) {
    const Scene scene = sceneWith(fill(R"("count": 1500)", R"({"constant": 0.03})"));
    EXPECT_EQ(scene.spheres.size(), 1500U);
    EXPECT_EQ(overlapsIn(scene), 0U);
}

TEST(SceneFill, PlacesVeryDifferentRadiiWithoutOverlaps) {
    const Scene scene = sceneWith(fill(R"("count": 800)", R"({"uniform": {"min": 0.002, "max": 0.06}})"));
    EXPECT_EQ(scene.spheres.size(), 800U);
    EXPECT_EQ(overlapsIn(scene), 0U);
}

TEST(SceneFill, KeepsTheOrderOfRadii) {
    // Large spheres are placed first, but ids keep the order in which radii are drawn.
    const Scene scene = sceneWith(fill(R"("count": 100)", R"({"uniform": {"min": 0.01, "max": 0.05}})"));
    const auto rises = [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; };
    const auto falls = [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; };
    EXPECT_FALSE(std::is_sorted(scene.spheres.begin(), scene.spheres.end(), rises));
    EXPECT_FALSE(std::is_sorted(scene.spheres.begin(), scene.spheres.end(), falls));
}

TEST(SceneFill, AvoidsEarlierGroupsAndObstacles) {
    const Scene scene = sceneWith(R"(
        "obstacles": [{"box": {"min": [0.4, 0, 0], "max": [0.6, 1, 1]}},
                      {"plane": {"point": [0, 0, 0.2], "normal": [0, 0, 1]}}],
        "groups": [{"list": {"spheres": [{"position": [0.2, 0.5, 0.6], "radius": 0.2}]}},
                   {"fill": {"min": [0, 0, 0], "max": [1, 1, 1], "count": 500}, "radius": {"constant": 0.02}}])");
    EXPECT_EQ(scene.spheres.size(), 501U);
    EXPECT_EQ(overlapsIn(scene), 0U);
    for (const Sphere& s : scene.spheres) {
        EXPECT_FALSE(obstacleAt(scene, s.position, static_cast<double>(s.radius)));
    }
}

TEST(SceneFill, DependsOnTheSeed) {
    const auto first = [](const std::string& seed, const Overrides& overrides = {}) {
        return sceneWith(fill(R"("count": 5, "seed": )" + seed, R"({"constant": 0.03})"), overrides)
            .spheres[4]
            .position;
    };
    EXPECT_EQ(first("1"), first("1"));
    EXPECT_NE(first("1"), first("2"));
    EXPECT_EQ(first("1", {.seed = 2}), first("2"));
}

TEST(SceneFill, RefusesMoreSpheresThanTheVolumeHolds) {
    EXPECT_EQ(refusalOf(fill(R"("count": 5000)", R"({"constant": 0.05})")),
              "groups[0].fill.count: asks for 5000 spheres in 2.618 of the volume of the region, but spheres of these "
              "radii jam at about 0.634; ask for less, or make the region larger");
}

TEST(SceneFill, AvoidsHundredsOfEarlierGroups) {
    std::string groups =
        R"({"lattice": {"min": [0,0,0], "max": [1,1,1], "spacing": 0.4}, "radius": {"constant": 0.1}})";
    for (int k = 0; k < 300; ++k)
        groups += R"(,{"fill": {"min": [0,0,0], "max": [1,1,1], "count": 1}, "radius": {"constant": )" +
                  std::string(k % 2 == 0 ? "0.03" : "0.01") + "}}";
    const Scene scene = sceneWith(R"("groups": [)" + groups + "]");
    EXPECT_EQ(scene.spheres.size(), 327U);
    EXPECT_EQ(overlapsIn(scene), 0U);
}

TEST(SceneFill, PacksWhatRandomPlacesDoNotReach) {
    const Scene scene = sceneWith(fill(R"("count": 900)", R"({"constant": 0.05})"));
    EXPECT_EQ(scene.spheres.size(), 900U);
    EXPECT_EQ(overlapsIn(scene), 0U);
}

TEST(SceneFill, FailsWhenThereIsNoSpace) {
    const std::string text = refusalOf(R"("obstacles": [{"box": {"min": [-1, -1, -1], "max": [2, 2, 1.5]}}], )" +
                                       fill(R"("count": 20)", R"({"constant": 0.05})"));
    EXPECT_EQ(text,
              "groups[0].fill.count: asks for 20 spheres in 0.01047 of the volume of the region, but obstacles and "
              "the shape of the region leave no places; ask for less, or make the region larger");
}

TEST(SceneFill, RefusesInvalidValues) {
    EXPECT_EQ(refusalOf(fill(R"("seed": 1)", R"({"constant": 0.05})")),
              "groups[0].fill.count: is 0 or missing, must be at least 1; or give a fraction");
    EXPECT_EQ(refusalOf(fill(R"("count": 1)", R"({"constant": 0.6})")),
              "groups[0].fill: is 1 m wide, too narrow for a radius of 0.6 m");
    EXPECT_NE(
        refusalOf(group(R"("fill": {"min": [0,0,0], "max": [9,1,1], "count": 100}, "radius": {"constant": 0.05})"))
            .find("groups[0].fill: reaches x = 9, outside the bounds"),
        std::string::npos);
}

TEST(SceneFill, OccupancyAgreesWithBruteForce) {
    Random random(3);
    Occupancy occupancy(0.15);  // smaller than the largest radius: slower, with the same results
    std::vector<std::pair<glm::dvec3, double>> taken;
    int free = 0;
    for (int i = 0; i < 3000; ++i) {
        glm::dvec3 p{};
        for (int axis = 0; axis < 3; ++axis) p[axis] = random.uniform(-1, 1);
        const double r = i % 3 == 0 ? 0.2 : i % 3 == 1 ? 0.01 : 0.0007;
        const bool expected = std::none_of(taken.begin(), taken.end(),
                                           [&](const auto& t) { return glm::distance(t.first, p) < t.second + r; });
        ASSERT_EQ(occupancy.isFree(p, r), expected) << i;
        if (!expected) continue;
        occupancy.add(p, r);
        taken.emplace_back(p, r);
        ++free;
    }
    EXPECT_GT(free, 500);
    EXPECT_LT(free, 2900);
}

}  // namespace
}  // namespace spherule::scene::testing
