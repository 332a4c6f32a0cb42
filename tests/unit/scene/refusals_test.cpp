#include <gtest/gtest.h>

#include "scene/check.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

TEST(SceneRefusals, EmptySceneWithBoundsIsAccepted) {
    const Scene scene = sceneWith("");
    EXPECT_TRUE(scene.spheres.empty());
    EXPECT_EQ(scene.forces.gravity, glm::dvec3(0, 0, -9.81));
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].restitution, 0.5);
    EXPECT_TRUE(scene.pairs.empty());
    EXPECT_EQ(scene.step, 1.0 / 60);
    EXPECT_EQ(scene.quality.model, Model::Balanced);
    EXPECT_EQ(scene.quality.substeps, 8U);
    EXPECT_TRUE(scene.sleep.enabled);
    EXPECT_EQ(scene.sleep.speed, 0.02);
    EXPECT_EQ(scene.sleep.time, 0.5);
    EXPECT_TRUE(scene.sphereContacts);
}

TEST(SceneRefusals, VectorsHaveThreeNumbers) {
    EXPECT_EQ(refusalOf(R"("gravity": [0, 0])"), "gravity: has 2 numbers, must have three: x, y, z");
    EXPECT_EQ(refusalOf(R"("gravity": [1])"), "gravity: has 1 number, must have three: x, y, z");
    EXPECT_EQ(refusalOf(R"("gravity": [0, 0, 0, 0])"), "gravity: has 4 numbers, must have three: x, y, z");
}

TEST(SceneRefusals, NumbersAreFinite) {
    EXPECT_EQ(refusalOf(R"("gravity": [0, 0, "NaN"])"), "gravity[2]: is nan, must be a finite number");
    EXPECT_EQ(refusalOf(R"("gravity": [0, "-Infinity", 0])"), "gravity[1]: is -inf, must be a finite number");
    EXPECT_EQ(refusalOf(R"("materials": [{"restitution": "NaN"}])"),
              "materials[0].restitution: is nan, must be a finite number");
    EXPECT_EQ(refusalOf(R"("materials": [{"density": "NaN"}])"),
              "materials[0].density: is nan, must be a finite number");
    EXPECT_EQ(refusalOf(R"("quality": {"overlap": "NaN"})"), "quality.overlap: is nan, must be a finite number");
    EXPECT_EQ(refusalOf(R"("step": "NaN")"), "step: is nan, must be a finite number");
    EXPECT_EQ(refusalOf(R"("sleep": {"speed": "Infinity"})"), "sleep.speed: is inf, must be a finite number");
    EXPECT_EQ(refusalOf(R"("camera": {"fieldOfView": "NaN"})"), "camera.fieldOfView: is nan, must be a finite number");
    EXPECT_EQ(refusalOf(group(R"("list": {}, "radius": {"constant": "NaN"})")),
              "groups[0].radius.constant: is nan, must be a finite number");
    EXPECT_EQ(refusalOf(group(R"("lattice": {"min": [0,0,0], "max": [1,1,1], "spacing": "NaN"},
                                 "radius": {"constant": 0.1})")),
              "groups[0].lattice.spacing: is nan, must be a finite number");
}

TEST(SceneRefusals, NumbersFitTheSimulation) {
    EXPECT_EQ(refusalOf(R"("gravity": [0, 0, 1e300])"), "gravity[2]: is 1e+300, must be -1000000000 to 1000000000");
}

TEST(SceneRefusals, FieldsHaveOneKindAndAreBounded) {
    EXPECT_EQ(refusalOf(R"("fields": [{}])"), "fields[0]: has no kind, must be drag, attraction, buoyancy or spring");
    EXPECT_EQ(refusalOf(R"("fields": [{"drag": {}}, {"drag": {"density": -1}}])"),
              "fields[1].drag.density: is -1, must be 0 to 100000 kg/m^3");
    EXPECT_EQ(refusalOf(R"("fields": [{"attraction": {"strength": 1, "softening": 1}}])"),
              "fields[0].attraction.centre: has 0 numbers, must have three: x, y, z");
    EXPECT_EQ(refusalOf(R"("fields": [{"attraction": {"centre": [0,0,0], "strength": 1}}])"),
              "fields[0].attraction.softening: is 0, must be 1e-06 to 1000000000 m");
    EXPECT_EQ(refusalOf(R"("fields": [{"attraction": {"centre": [0,0,0], "strength": 1e3, "softening": 0.01}}])"),
              "fields[0].attraction: accelerates spheres near its centre by up to 3.85e+06 m/s^2, at most 1e+06 is "
              "allowed; use a larger softening or a smaller strength");
    std::string nine = R"({"drag": {}})";
    for (int k = 0; k < 8; ++k) nine += R"(, {"drag": {}})";
    EXPECT_EQ(refusalOf(R"("fields": [)" + nine + "]"), "fields: has 9 entries, must have at most 8");
}

TEST(SceneRefusals, FieldsAreRead) {
    const Scene scene = sceneWith(R"("fields": [{"drag": {}},
        {"attraction": {"centre": [1, 2, 3], "strength": -4, "softening": 0.5}}])");
    ASSERT_EQ(scene.forces.fields.size(), 2U);
    EXPECT_EQ(std::get<Drag>(scene.forces.fields[0]).density, 1.2);
    EXPECT_EQ(std::get<Drag>(scene.forces.fields[0]).coefficient, 0.47);
    EXPECT_EQ(std::get<Attraction>(scene.forces.fields[1]).centre, glm::dvec3(1, 2, 3));
    EXPECT_EQ(std::get<Attraction>(scene.forces.fields[1]).strength, -4);
}

// Returns the scene with one field, which has this content.
std::string refusalOfField(const std::string& field) {
    return refusalOf("\"fields\": [{" + field + "}]");
}

TEST(SceneRefusals, MediaAreBounded) {
    EXPECT_EQ(refusalOfField(R"("drag": {"velocity": [1, 2]})"),
              "fields[0].drag.velocity: has 2 numbers, must have three: x, y, z");
    EXPECT_EQ(refusalOfField(R"("drag": {"velocity": [0, 0, 2e5]})"),
              "fields[0].drag.velocity: is 200000 m/s long, at most 100000 is allowed");
    EXPECT_EQ(refusalOfField(R"("drag": {"vortex": {"axis": [0, 0, 1], "core": 1}})"),
              "fields[0].drag.vortex.centre: has 0 numbers, must have three: x, y, z");
    EXPECT_EQ(refusalOfField(R"("drag": {"vortex": {"centre": [0, 0, 1], "axis": [0, 0, 0], "core": 1}})"),
              "fields[0].drag.vortex.axis: is zero, must have a direction");
    EXPECT_EQ(refusalOfField(R"("drag": {"vortex": {"centre": [0, 0, 1], "axis": [0, 0, 1], "speed": 1}})"),
              "fields[0].drag.vortex.core: is 0, must be 1e-06 to 1000000000 m");
    EXPECT_EQ(
        refusalOfField(R"("drag": {"vortex": {"centre": [0, 0, 1], "axis": [0, 0, 1], "speed": 1e6, "core": 1}})"),
        "fields[0].drag.vortex.speed: is 1000000, must be -100000 to 100000 m/s");
}

TEST(SceneRefusals, LiquidsAndSpringsAreBounded) {
    EXPECT_EQ(refusalOfField(R"("buoyancy": {"density": -1})"),
              "fields[0].buoyancy.density: is -1, must be 0 to 100000 kg/m^3");
    EXPECT_EQ(refusalOfField(R"("buoyancy": {"surface": [1]})"),
              "fields[0].buoyancy.surface: has 1 number, must have three: x, y, z");
    EXPECT_EQ(refusalOf(R"("gravity": [0, 0, 0], "fields": [{"drag": {}}, {"buoyancy": {}}])"),
              "fields[1].buoyancy: needs gravity, which is zero; give the scene a gravity or remove the buoyancy");
    EXPECT_EQ(refusalOfField(R"("spring": {"stiffness": 1})"),
              "fields[0].spring.centre: has 0 numbers, must have three: x, y, z");
    EXPECT_EQ(refusalOfField(R"("spring": {"centre": [0, 0, 0], "stiffness": -1})"),
              "fields[0].spring.stiffness: is -1, must be 0 to 1000000000 N/m");
    EXPECT_EQ(refusalOfField(R"("spring": {"centre": [0, 0, 0], "damping": -1})"),
              "fields[0].spring.damping: is -1, must be 0 to 1000000000 N s/m");
}

TEST(SceneRefusals, RegionsAreTheInsideOfSolids) {
    const std::string hollow = ": is true; a region is the inside of a solid shape: leave it out";
    EXPECT_EQ(refusalOfField(R"("drag": {}, "inBox": {"min": [0, 0, 0], "max": [1, 1, 1], "hollow": true})"),
              "fields[0].inBox.hollow" + hollow);
    EXPECT_EQ(refusalOfField(R"("drag": {}, "inSphere": {"centre": [0, 0, 0], "radius": 1, "hollow": true})"),
              "fields[0].inSphere.hollow" + hollow);
    EXPECT_EQ(
        refusalOfField(R"("drag": {}, "inCylinder": {"from": [0,0,0], "to": [0,0,1], "radius": 1, "open": true})"),
        "fields[0].inCylinder.open" + hollow);
    EXPECT_EQ(refusalOfField(R"("drag": {}, "inBox": {"min": [0, 0, 0], "max": [1, 0, 1]})"),
              "fields[0].inBox.max[1]: is 0, must be above min, which is 0");
    EXPECT_EQ(refusalOfField(R"("drag": {}, "inSphere": {"centre": [0, 0, 0]})"),
              "fields[0].inSphere.radius: is 0, must be positive");
    EXPECT_EQ(refusalOfField(R"("drag": {}, "inCylinder": {"from": [0, 0, 0], "to": [0, 0, 0], "radius": 1})"),
              "fields[0].inCylinder.to: is (0, 0, 0), must differ from `from`");
}

TEST(SceneRefusals, KindsAndRegionsOfFieldsAreRead) {
    const Scene scene = sceneWith(R"("fields": [
        {"drag": {"velocity": [1, 2, 3], "vortex": {"centre": [0, 1, 0], "axis": [0, 0, -2], "speed": -4, "core": 5}},
         "inCylinder": {"from": [0, 0, 0], "to": [0, 0, 2], "radius": 3}},
        {"buoyancy": {"surface": [0, 0, 0.5]}, "inSphere": {"centre": [1, 0, 0], "radius": 2}}, {"buoyancy": {}},
        {"spring": {"centre": [1, 2, 3], "stiffness": 4, "damping": 5}, "inBox": {"min": [0,0,0], "max": [1,2,3]}}])");
    const auto& drag = std::get<Drag>(scene.forces.fields[0]);
    EXPECT_EQ(drag.velocity, glm::dvec3(1, 2, 3));
    EXPECT_EQ(drag.vortex->axis, glm::dvec3(0, 0, -1));
    EXPECT_EQ(drag.vortex->speed, -4);
    EXPECT_EQ(drag.vortex->core, 5);
    EXPECT_EQ(std::get<CylinderRegion>(*drag.region).radius, 3);
    EXPECT_EQ(*std::get<Buoyancy>(scene.forces.fields[1]).surface, glm::dvec3(0, 0, 0.5));
    EXPECT_EQ(std::get<BallRegion>(*regionOf(scene.forces.fields[1])).centre, glm::dvec3(1, 0, 0));
    EXPECT_EQ(std::get<Buoyancy>(scene.forces.fields[2]).density, 1000);
    EXPECT_FALSE(std::get<Buoyancy>(scene.forces.fields[2]).surface);
    EXPECT_FALSE(regionOf(scene.forces.fields[2]));
    EXPECT_EQ(std::get<Spring>(scene.forces.fields[3]).stiffness, 4);
    EXPECT_EQ(std::get<Spring>(scene.forces.fields[3]).damping, 5);
    EXPECT_EQ(std::get<Box>(*regionOf(scene.forces.fields[3])).max, glm::dvec3(1, 2, 3));
}

TEST(SceneRefusals, NamesAreLimited) {
    EXPECT_EQ(refusalOf(R"("name": ")" + std::string(longestName, 'n') + "\""), "accepted");
    EXPECT_EQ(refusalOf(R"("name": ")" + std::string(longestName + 1, 'n') + "\""),
              "name: is 201 bytes long, must be at most 200");
}

TEST(SceneRefusals, NamesOfFilesBecomeUtf8) {
    const TemporaryFolder folder;
    const auto named = load(folder.write("caf\xe9.json", R"({"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}})"), "cpu");
    ASSERT_TRUE(named) << named.error().text();
    EXPECT_EQ(named->name, "caf\xef\xbf\xbd");
}

TEST(SceneRefusals, StepHasARange) {
    EXPECT_EQ(refusalOf(R"("step": 0)"), "step: is 0, must be 1e-06 to 1 s");
    EXPECT_EQ(refusalOf(R"("step": 1.5)"), "step: is 1.5, must be 1e-06 to 1 s");
}

TEST(SceneRefusals, SleepHasPositiveLimits) {
    EXPECT_EQ(refusalOf(R"("sleep": {"speed": 0})"), "sleep.speed: is 0, must be positive");
    EXPECT_EQ(refusalOf(R"("sleep": {"time": -1})"), "sleep.time: is -1, must be positive");
    EXPECT_EQ(refusalOf(R"("sleep": {"time": 1e6})"), "sleep.time: is 1000000, must be at most 3600 s");
}

TEST(SceneRefusals, ColoursAreHexadecimal) {
    EXPECT_EQ(refusalOf(group(R"("list": {}, "colour": "red")")),
              R"(groups[0].colour: is "red", must be #rrggbb in hexadecimal)");
    EXPECT_EQ(refusalOf(group(R"("list": {}, "colour": "#12345g")")),
              R"(groups[0].colour: is "#12345g", must be #rrggbb in hexadecimal)");
    EXPECT_EQ(refusalOf(group(R"("list": {}, "roughness": 1.5)")), "groups[0].roughness: is 1.5, must be 0 to 1");
    EXPECT_EQ(refusalOf(group(R"("list": {}, "metal": -0.1)")), "groups[0].metal: is -0.1, must be 0 to 1");
    EXPECT_EQ(refusalOf(group(R"("list": {}, "colour": "#1A2b3C")")), "accepted");
}

TEST(SceneRefusals, TextInAMessageIsCutAndPrintable) {
    const std::string text = refusalOf(group(R"("list": {}, "colour": "\n)" + std::string(1000, 'x') + "\""));
    EXPECT_EQ(text, "groups[0].colour: is \"?" + std::string(39, 'x') + "...\", must be #rrggbb in hexadecimal");
}

TEST(SceneRefusals, FirstOfSeveralErrorsIsReported) {
    EXPECT_EQ(refusalOf(R"("gravity": [1], "materials": [{"restitution": 7}])"),
              "gravity: has 1 number, must have three: x, y, z");
}

TEST(SceneRefusals, VectorOfNamesItsField) {
    Numbers values;
    for (const double v : {1.0, 2.0}) values.Add(v);
    EXPECT_EQ(vectorOf(values, "impulse").error().text(), "impulse: has 2 numbers, must have three: x, y, z");
    values.Add(3.0);
    EXPECT_EQ(*vectorOf(values, "impulse"), glm::dvec3(1, 2, 3));
}

}  // namespace
}  // namespace spherule::scene::testing
