#include <gtest/gtest.h>

#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

std::string lattice(const std::string& more, const std::string& radius = R"({"constant": 0.1})") {
    return group(R"("lattice": {"min": [0, 0, 0], "max": [1, 1, 1], )" + more + R"(}, "radius": )" + radius);
}

TEST(SceneLattice, FillsTheRegionAlongXThenYThenZ) {
    const Scene scene = sceneWith(lattice(R"("spacing": 0.4)"));
    ASSERT_EQ(scene.spheres.size(), 27U);  // centres between 0.1 and 0.9 m
    EXPECT_NEAR(scene.spheres[0].position.x, 0.1, 1e-12);
    EXPECT_NEAR(scene.spheres[1].position.x, 0.5, 1e-12);
    EXPECT_NEAR(scene.spheres[1].position.y, 0.1, 1e-12);
    EXPECT_NEAR(scene.spheres[3].position.y, 0.5, 1e-12);
    EXPECT_NEAR(scene.spheres[9].position.z, 0.5, 1e-12);
    EXPECT_NEAR(scene.spheres[26].position.z, 0.9, 1e-12);
}

TEST(SceneLattice, IsCentredInXAndYAndStartsAtTheBottom) {
    const Scene scene = sceneWith(lattice(R"("spacing": 0.5)"));
    ASSERT_EQ(scene.spheres.size(), 8U);
    EXPECT_NEAR(scene.spheres[0].position.x, 0.25, 1e-12);
    EXPECT_NEAR(scene.spheres[0].position.y, 0.25, 1e-12);
    EXPECT_NEAR(scene.spheres[0].position.z, 0.1, 1e-12);
}

TEST(SceneLattice, StopsAtItsCount) {
    EXPECT_EQ(sceneWith(lattice(R"("spacing": 0.4, "count": 11)")).spheres.size(), 11U);
    EXPECT_EQ(sceneWith(lattice(R"("spacing": 0.4, "count": 0)")).spheres.size(), 0U);
    EXPECT_EQ(
        refusalOf(lattice(R"("spacing": 0.4, "count": 28)")),
        "groups[0].lattice.count: asks for 28 spheres, but 3 x 3 x 3 fit between min and max at a spacing of 0.4 m");
}

TEST(SceneLattice, ReservesSpaceForTheLargestRadiusAndJitter) {
    EXPECT_EQ(sceneWith(lattice(R"("spacing": 0.4, "jitter": 0.01)")).spheres.size(), 8U);
    EXPECT_EQ(sceneWith(lattice(R"("spacing": 0.4)", R"({"uniform": {"min": 0.05, "max": 0.11}})")).spheres.size(), 8U);
}

TEST(SceneLattice, JitterIsBoundedAndFollowsTheSeed) {
    const std::string more = R"("spacing": 0.3, "jitter": 0.02, "seed": )";
    const Scene plain = sceneWith(lattice(R"("spacing": 0.3, "jitter": 0)"));
    const Scene one = sceneWith(lattice(more + "1"));
    const Scene again = sceneWith(lattice(more + "1"));
    const Scene two = sceneWith(lattice(more + "2"));
    ASSERT_EQ(one.spheres.size(), 27U);
    double largest = 0;
    for (std::size_t i = 0; i < one.spheres.size(); ++i) {
        EXPECT_EQ(one.spheres[i].position, again.spheres[i].position);
        EXPECT_NE(one.spheres[i].position, two.spheres[i].position);
        for (int axis = 0; axis < 2; ++axis) {
            largest = std::max(largest, std::abs(one.spheres[i].position[axis] - plain.spheres[i].position[axis]));
        }
    }
    EXPECT_LE(largest, 0.02);
    EXPECT_GT(largest, 0.018);
}

TEST(SceneLattice, DefaultSeedIsOne) {
    const Scene absent = sceneWith(lattice(R"("spacing": 0.3, "jitter": 0.02)"));
    const Scene one = sceneWith(lattice(R"("spacing": 0.3, "jitter": 0.02, "seed": 1)"));
    EXPECT_EQ(absent.spheres[5].position, one.spheres[5].position);
}

TEST(SceneLattice, OverrideReplacesTheSeed) {
    const std::string members = lattice(R"("spacing": 0.3, "jitter": 0.02, "seed": 1)");
    const Scene two = sceneWith(lattice(R"("spacing": 0.3, "jitter": 0.02, "seed": 2)"));
    EXPECT_EQ(sceneWith(members, {.seed = 2}).spheres[5].position, two.spheres[5].position);
}

TEST(SceneLattice, GroupsWithTheSameSeedDiffer) {
    const std::string one = R"({"lattice": {"min": [0,0,0], "max": [1,1,1], "spacing": 0.3, "jitter": 0.02},
                                "radius": {"constant": 0.1}})";
    const Scene scene = sceneWith("\"groups\": [" + one + "," + one + "]");
    EXPECT_NE(scene.spheres[0].position, scene.spheres[27].position);
}

TEST(SceneLattice, RefusesInvalidValues) {
    EXPECT_EQ(refusalOf(lattice(R"("spacing": -0.1)")), "groups[0].lattice.spacing: is -0.1, must be positive");
    EXPECT_EQ(refusalOf(lattice(R"("jitter": 0)")), "groups[0].lattice.spacing: is 0, must be positive");
    EXPECT_EQ(refusalOf(lattice(R"("spacing": 0.3, "jitter": -1)")),
              "groups[0].lattice.jitter: is -1, must be 0 to 0.3 m (the spacing)");
    EXPECT_EQ(refusalOf(lattice(R"("spacing": 1e-7)", R"({"constant": 0.0001})")).substr(0, 33),
              "groups[0].lattice: asks for 99940");
    EXPECT_NE(refusalOf(lattice(R"("spacing": 1)", R"({"constant": 0.6})")).find("0 x 0 x 0 fit"), std::string::npos);
    EXPECT_EQ(
        refusalOf(group(R"("lattice": {"min": [0,0,0], "max": [1,-1,1], "spacing": 1}, "radius": {"constant": 0.1})")),
        "groups[0].lattice.max[1]: is -1, must be above min, which is 0");
    EXPECT_NE(
        refusalOf(group(R"("lattice": {"min": [0,0,0], "max": [1,1,2], "spacing": 0.4}, "radius": {"constant": 0.1})"))
            .find("groups[0].lattice: puts a sphere at"),
        std::string::npos);
}

TEST(SceneLattice, RefusesInfiniteSitesOnOneAxisAndNoneOnAnother) {
    EXPECT_NE(refusalOf(group(R"("lattice": {"min": [0,0,0], "max": [1e9,0.01,1e9], "spacing": 1e-300, "count": 5},
                                 "radius": {"constant": 0.05})"))
                  .find("fit between min and max"),
              std::string::npos);
}

}  // namespace
}  // namespace spherule::scene::testing
