#include <gtest/gtest.h>

#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

TEST(SceneGroups, ListSpheresInheritPropertiesOfTheGroup) {
    const Scene scene =
        sceneWith(R"("materials": [{"restitution": 0.3, "density": 500}, {"name": "b", "restitution": 0.9}], "groups": [
        {"name": "a", "colour": "#102030", "roughness": 0.25, "metal": 1,
         "velocity": [1, 2, 3], "spin": [4, 5, 6], "radius": {"constant": 0.1},
         "list": {"spheres": [{"position": [0.2, 0.3, 0.4]},
                              {"position": [0.6, 0.7, 0.8], "velocity": [0, 0, 1], "spin": [7, 0, 0], "radius": 0.05}]}},
        {"name": "b", "material": "b", "list": {"spheres": [{"position": [0.5, 0.5, 0.5], "radius": 0.2}]}}])");
    ASSERT_EQ(scene.spheres.size(), 3U);
    const auto& [first, second, third] = std::tie(scene.spheres[0], scene.spheres[1], scene.spheres[2]);
    EXPECT_EQ(first.position, glm::dvec3(0.2, 0.3, 0.4));
    EXPECT_EQ(first.velocity, glm::vec3(1, 2, 3));
    EXPECT_EQ(first.radius, 0.1F);
    EXPECT_EQ(first.spin, glm::vec3(4, 5, 6));
    EXPECT_EQ(scene.materials[first.material].density, 500);
    EXPECT_EQ(scene.materials[first.material].restitution, 0.3);
    EXPECT_EQ(second.velocity, glm::vec3(0, 0, 1));
    EXPECT_EQ(second.spin, glm::vec3(7, 0, 0));
    EXPECT_EQ(second.radius, 0.05F);
    EXPECT_EQ(second.material, first.material);
    EXPECT_EQ(third.spin, glm::vec3(0));
    EXPECT_EQ(scene.materials[third.material].density, 1000);
    EXPECT_EQ(scene.materials[third.material].restitution, 0.9);
    ASSERT_EQ(scene.groups.size(), 2U);
    EXPECT_EQ(scene.groups[0].name, "a");
    EXPECT_EQ(scene.groups[0].look.colour, "#102030");
    EXPECT_EQ(scene.groups[0].look.roughness, 0.25);
    EXPECT_EQ(scene.groups[0].look.metal, 1);
    EXPECT_EQ(scene.groups[1].look.roughness, 0.45);
    EXPECT_EQ(scene.groups[1].look.metal, 0);
    EXPECT_EQ(scene.groups[0].count, 2U);
    EXPECT_EQ(scene.spheres[1].group, 0U);
    EXPECT_EQ(scene.spheres[2].group, 1U);
    EXPECT_EQ(scene.groups[1].count, 1U);
}

TEST(SceneGroups, FixedSpheresAreMarkedAndAtRest) {
    const Scene scene = sceneWith(R"("groups": [
        {"fixed": true, "radius": {"constant": 0.1}, "list": {"spheres": [{"position": [0.5, 0.5, 0.5]}]}},
        {"radius": {"constant": 0.1}, "list": {"spheres": [{"position": [0.2, 0.5, 0.5]}]}}])");
    EXPECT_TRUE(scene.spheres.at(0).fixed);
    EXPECT_FALSE(scene.spheres.at(1).fixed);
    const std::string reason =
        " is at (0.5, 0.5, 0.5) with radius 0.1 and is fixed, so it can have neither velocity nor spin; leave these "
        "out, or leave out fixed";
    for (const char* const motion : {R"("velocity": [0, 0, 1])", R"("spin": [1, 0, 0])"})
        EXPECT_EQ(
            refusalOf(group(std::string(R"("fixed": true, )") + motion +
                            R"(, "radius": {"constant": 0.1}, "list": {"spheres": [{"position": [0.5, 0.5, 0.5]}]})")),
            "groups[0].list.spheres[0]:" + reason);
}

TEST(SceneGroups, OverlapsBetweenSpheresAreAllowed) {
    EXPECT_EQ(refusalOf(group(R"("radius": {"constant": 0.1}, "list": {"spheres": [
        {"position": [0.5, 0.5, 0.5]}, {"position": [0.5, 0.5, 0.5]}]})")),
              "accepted");
}

TEST(SceneGroups, EmptyListIsAccepted) {
    EXPECT_EQ(refusalOf(group(R"("list": {})")), "accepted");
}

TEST(SceneGroups, NeedASource) {
    EXPECT_EQ(refusalOf(group(R"("radius": {"constant": 0.1})")),
              "groups[0]: has no spheres, must have one of list, lattice, fill, csv, xyz, lammps");
}

TEST(SceneGroups, NeedARadiusIfTheSourceHasNone) {
    const std::string missing = "groups[0].radius: is missing; give one of constant, uniform, normal, logNormal, table";
    EXPECT_EQ(refusalOf(group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.5]}]})")), missing);
    EXPECT_EQ(refusalOf(group(R"("fill": {"min": [0,0,0], "max": [1,1,1], "count": 1})")), missing);
    EXPECT_EQ(refusalOf(group(R"("lattice": {"min": [0,0,0], "max": [1,1,1], "spacing": 0.5})")), missing);
    EXPECT_EQ(refusalOf(group(R"("list": {}, "radius": {})")),
              "groups[0].radius: is empty, must be one of constant, uniform, normal, logNormal, table");
}

TEST(SceneGroups, RadiiArePositive) {
    const auto withRadius = [](const std::string& radius) {
        return refusalOf(group(R"("list": {}, "radius": )" + radius));
    };
    EXPECT_EQ(withRadius(R"({"constant": 0})"), "groups[0].radius.constant: is 0, must be positive");
    EXPECT_EQ(withRadius(R"({"constant": -0.1})"), "groups[0].radius.constant: is -0.1, must be positive");
    EXPECT_EQ(withRadius(R"({"constant": 1e-9})"), "groups[0].radius.constant: is 1e-09, must be 1e-06 to 1000000 m");
    EXPECT_EQ(withRadius(R"({"uniform": {"min": 0.2, "max": 0.1}})"),
              "groups[0].radius.uniform.max: is 0.1, must be above min, 0.2");
    EXPECT_EQ(withRadius(R"({"uniform": {"max": 0.1}})"), "groups[0].radius.uniform.min: is 0, must be positive");
    EXPECT_EQ(withRadius(R"({"normal": {"min": 0.1, "max": 0.2, "mean": 0.3, "deviation": 0.01}})"),
              "groups[0].radius.normal.mean: is 0.3, must be 0.1 to 0.2 (min to max)");
    EXPECT_EQ(withRadius(R"({"normal": {"min": 0.1, "max": 0.2, "mean": 0.15, "deviation": 0}})"),
              "groups[0].radius.normal.deviation: is 0, must be positive");
    EXPECT_EQ(withRadius(R"({"normal": {"min": 0.25, "max": 0.5, "mean": 0.3, "deviation": 5}})"),
              "groups[0].radius.normal.deviation: is 5, must be at most 0.25 (max - min; for a wider one use uniform)");
    EXPECT_EQ(refusalOf(group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.5], "radius": -1}]})")),
              "groups[0].list.spheres[0].radius: is -1, must be positive");
}

TEST(SceneGroups, SpheresOfEverySourceHaveTheVelocityAndSpinOfTheGroup) {
    for (const std::string source : {R"("list": {"spheres": [{"position": [0.5, 0.5, 0.5]}]})",
                                     R"("lattice": {"min": [0,0,0], "max": [1,1,1], "spacing": 0.5})",
                                     R"("fill": {"min": [0,0,0], "max": [1,1,1], "count": 3})"}) {
        const Scene scene =
            sceneWith(group(source + R"(, "radius": {"constant": 0.1}, "velocity": [1, 2, 3], "spin": [4, 5, 6])"));
        ASSERT_FALSE(scene.spheres.empty()) << source;
        for (const Sphere& sphere : scene.spheres) {
            EXPECT_EQ(sphere.velocity, glm::vec3(1, 2, 3)) << source;
            EXPECT_EQ(sphere.spin, glm::vec3(4, 5, 6)) << source;
        }
    }
}

TEST(SceneGroups, VectorsAreChecked) {
    EXPECT_EQ(refusalOf(group(R"("list": {"spheres": [{"position": [0, 0], "radius": 0.1}]})")),
              "groups[0].list.spheres[0].position: has 2 numbers, must have three: x, y, z");
    EXPECT_EQ(refusalOf(group(R"("list": {"spheres": [{"position": [0.5, 0.5, "NaN"], "radius": 0.1}]})")),
              "groups[0].list.spheres[0].position[2]: is nan, must be a finite number");
    EXPECT_EQ(
        refusalOf(group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.5], "velocity": [1], "radius": 0.1}]})")),
        "groups[0].list.spheres[0].velocity: has 1 number, must have three: x, y, z");
    EXPECT_EQ(refusalOf(group(R"("list": {}, "velocity": [1, 2])")),
              "groups[0].velocity: has 2 numbers, must have three: x, y, z");
    EXPECT_EQ(refusalOf(group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.5], "spin": [1], "radius": 0.1}]})")),
              "groups[0].list.spheres[0].spin: has 1 number, must have three: x, y, z");
    EXPECT_EQ(refusalOf(group(R"("list": {}, "spin": [0, "NaN", 0])")),
              "groups[0].spin[1]: is nan, must be a finite number");
}

TEST(SceneGroups, LimitTheTotalNumberOfSpheres) {
    const std::string text = refusalOf(R"("groups": [
        {"list": {"spheres": [{"position": [0.5, 0.5, 0.5]}]}, "radius": {"constant": 0.001}},
        {"fill": {"min": [0,0,0], "max": [1,1,1], "count": 16000000}, "radius": {"constant": 0.001}}])");
    EXPECT_EQ(text,
              "groups[1].fill.count: asks for 16000000 spheres, but a scene holds at most 16000000 and has room for "
              "15999999");
}

TEST(SceneGroups, LimitThePairsOfSpheresAndObstacles) {
    std::string obstacles = R"({"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}})";
    for (std::uint32_t k = 1; k < maxObstacles; ++k)
        obstacles += R"(, {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}})";
    EXPECT_EQ(refusalOf(R"("obstacles": [)" + obstacles + "], " +
                        group(R"("radius": {"constant": 0.002}, "lattice": {"min": [0, 0, 0], "max": [1, 1, 1],
                                 "spacing": 0.005, "count": 30001})")),
              "groups[0].lattice: makes 30001 spheres in all, 30001000 pairs with the 1000 obstacles, but a scene "
              "holds at most 30000000; use fewer of one or the other");
}

TEST(SceneGroups, AreLimitedInNumberAndName) {
    std::string groups = R"({"list": {}, "name": ")" + std::string(longestName, 'n') + R"("})";
    EXPECT_EQ(refusalOf(R"("groups": [)" + groups + "]"), "accepted");
    for (std::uint32_t k = 0; k < maxGroups; ++k) groups += R"(,{"list":{}})";
    EXPECT_EQ(refusalOf(R"("groups": [)" + groups + "]"), "groups: has 10001 entries, must have at most 10000");
    EXPECT_EQ(refusalOf(group(R"("list": {}, "name": ")" + std::string(longestName + 1, 'n') + "\"")),
              "groups[0].name: is 201 bytes long, must be at most 200");

    Scene full = sceneWith("");
    full.groups.resize(maxGroups);
    const auto spawned = buildGroup(
        parsed(object(group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.5], "radius": 0.1}]})"))).groups(0),
        full);
    ASSERT_FALSE(spawned);
    EXPECT_EQ(spawned.error().text(), "group: is one too many, a scene has at most 10000");
}

TEST(SceneGroups, InlineSceneMayNotNameFiles) {
    for (const std::string source : {"csv", "xyz", "lammps"})
        EXPECT_EQ(refusalOf(group('"' + source + R"(": {"file": "/etc/passwd"})")),
                  "groups[0]." + source +
                      ": names the file \"/etc/passwd\", but only a scene file may name files; give the spheres as a "
                      "list");
}

TEST(SceneGroups, SpawnedGroupObeysTheRulesOfTheScene) {
    const Scene scene = sceneWith(R"("materials": [{"name": "a"}, {"name": "b", "restitution": 0.7}],
        "obstacles": [{"plane": {"point": [0, 0, 0.3], "normal": [0, 0, 1]}}])");
    const auto spawned = [&](const std::string& members) {
        return buildGroup(parsed(object(group(members))).groups(0), scene);
    };
    const auto good =
        spawned(R"("material": "b", "list": {"spheres": [{"position": [0.5, 0.5, 0.5], "radius": 0.1}]})");
    ASSERT_TRUE(good) << good.error().text();
    EXPECT_EQ(good->size(), 1U);
    EXPECT_EQ(scene.materials.at(good->front().material).restitution, 0.7);
    EXPECT_EQ(spawned(R"("material": "c", "list": {})").error().text(),
              R"(group.material: is "c", which is no material of the scene; it has "a", "b")");
    EXPECT_EQ(spawned(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.2], "radius": 0.1}]})").error().text(),
              "group.list.spheres[0]: is at (0.5, 0.5, 0.2) with radius 0.1 and reaches into obstacles[0]");
    EXPECT_NE(spawned(R"("csv": {"file": "x.csv"})").error().text().find("only a scene file may name files"),
              std::string::npos);
    EXPECT_EQ(
        spawned(R"("radius": {"constant": 1e-6}, "list": {"spheres": [{"position": [0.5, 0.5, 0.5]}]})").error().where,
        "group.radius");
}

}  // namespace
}  // namespace spherule::scene::testing
