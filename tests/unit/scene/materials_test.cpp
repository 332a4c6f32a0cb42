#include "scene/materials.h"

#include <gtest/gtest.h>

#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

std::string refusalOfMaterial(const std::string& members) {
    return refusalOf(R"("materials": [)" + object(members) + "]");
}

TEST(SceneMaterials, HaveDefaults) {
    for (const std::string materials : {"", R"("materials": [])", R"("materials": [{}])"}) {
        const Scene scene = sceneWith(materials);
        ASSERT_EQ(scene.materials.size(), 1U) << materials;
        const Material& material = scene.materials[0];
        EXPECT_EQ(material.name, "");
        EXPECT_EQ(material.density, 1000);
        EXPECT_EQ(material.restitution, 0.5);
        EXPECT_EQ(material.friction, 0);
        EXPECT_EQ(material.rollingResistance, 0);
        EXPECT_EQ(material.spinningResistance, 0);
        EXPECT_EQ(material.young, 0);
        EXPECT_EQ(material.poisson, 0.25);
    }
}

TEST(SceneMaterials, AreRead) {
    const Scene scene = sceneWith(R"("materials": [{}, {"name": "steel", "density": 7800, "restitution": 0.9,
        "friction": 0.2, "rollingResistance": 0.01, "spinningResistance": 0.02, "young": 2e11, "poisson": 0.3}])");
    ASSERT_EQ(scene.materials.size(), 2U);
    const Material& steel = scene.materials[1];
    EXPECT_EQ(steel.name, "steel");
    EXPECT_EQ(steel.density, 7800);
    EXPECT_EQ(steel.restitution, 0.9);
    EXPECT_EQ(steel.friction, 0.2);
    EXPECT_EQ(steel.rollingResistance, 0.01);
    EXPECT_EQ(steel.spinningResistance, 0.02);
    EXPECT_EQ(steel.young, 2e11);
    EXPECT_EQ(steel.poisson, 0.3);
}

TEST(SceneMaterials, FirstMaterialIsTheDefault) {
    const Scene scene = sceneWith(R"("materials": [{"name": "felt"}, {"name": "steel"}],
        "obstacles": [{"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}], "groups": [
            {"list": {"spheres": [{"position": [0.3, 0.3, 0.3], "radius": 0.1}]}},
            {"list": {"spheres": [{"position": [0.6, 0.6, 0.6], "radius": 0.1}]}, "material": "steel"},
            {"list": {"spheres": [{"position": [0.8, 0.8, 0.8], "radius": 0.1}]}, "material": "felt"}])");
    EXPECT_EQ(scene.bounds.material, 0);
    EXPECT_EQ(scene.obstacles[0].material, 0);
    EXPECT_EQ(scene.spheres[0].material, 0);
    EXPECT_EQ(scene.spheres[1].material, 1);
    EXPECT_EQ(scene.spheres[2].material, 0);
}

TEST(SceneMaterials, UnknownNamesAreRefusedWithTheKnownOnes) {
    const std::string steelGroup = group(R"("list": {}, "material": "stell")");
    EXPECT_EQ(
        refusalOf(R"("materials": [{}, {"name": "felt"}, {"name": "steel"}], )" + steelGroup),
        R"(groups[0].material: is "stell", which is no material of the scene; it has "felt", "steel"; did you mean "steel"?)");
    EXPECT_EQ(refusalOf(steelGroup),
              R"(groups[0].material: is "stell", which is no material of the scene; it has none with a name)");
}

TEST(SceneMaterials, OnlyTheFirstMayHaveNoName) {
    EXPECT_EQ(refusalOf(R"("materials": [{"name": "felt"}, {}])"),
              "materials[1].name: is missing; only the first material may go without");
    EXPECT_EQ(refusalOf(R"("materials": [{}, {}])"),
              "materials[1].name: is missing; only the first material may go without");
}

TEST(SceneMaterials, NamesAreUnique) {
    EXPECT_EQ(refusalOf(R"("materials": [{"name": "felt"}, {"name": "steel"}, {"name": "felt"}])"),
              R"(materials[2].name: is "felt", the name of another material)");
    EXPECT_EQ(refusalOf(R"("materials": [{"name": "felt"}, {"name": "Felt"}])"), "accepted");
}

TEST(SceneMaterials, PropertiesHaveARange) {
    EXPECT_EQ(refusalOfMaterial(R"("density": 0)"), "materials[0].density: is 0, must be 1e-06 to 1000000000 kg/m^3");
    EXPECT_EQ(refusalOfMaterial(R"("density": -3)"), "materials[0].density: is -3, must be 1e-06 to 1000000000 kg/m^3");
    EXPECT_EQ(refusalOfMaterial(R"("density": 1e12)"),
              "materials[0].density: is 1000000000000, must be 1e-06 to 1000000000 kg/m^3");
    EXPECT_EQ(refusalOfMaterial(R"("restitution": 1.1)"), "materials[0].restitution: is 1.1, must be 0 to 1");
    EXPECT_EQ(refusalOfMaterial(R"("restitution": -0.1)"), "materials[0].restitution: is -0.1, must be 0 to 1");
    for (const std::string member : {"friction", "rollingResistance", "spinningResistance"}) {
        const std::string field = "materials[0]." + member;
        EXPECT_EQ(refusalOfMaterial("\"" + member + "\": -0.1"), field + ": is -0.1, must be 0 to 100");
        EXPECT_EQ(refusalOfMaterial("\"" + member + "\": 101"), field + ": is 101, must be 0 to 100");
    }
    EXPECT_EQ(refusalOfMaterial(R"("young": 0)"), "materials[0].young: is 0, must be 0.001 to 1000000000000000 Pa");
    EXPECT_EQ(refusalOfMaterial(R"("young": 1e16)"),
              "materials[0].young: is 1e+16, must be 0.001 to 1000000000000000 Pa");
    EXPECT_EQ(refusalOfMaterial(R"("poisson": -1)"), "materials[0].poisson: is -1, must be -0.99 to 0.5");
    EXPECT_EQ(refusalOfMaterial(R"("poisson": 0.51)"), "materials[0].poisson: is 0.51, must be -0.99 to 0.5");
}

TEST(SceneMaterials, PropertiesMayEqualTheirLimits) {
    EXPECT_EQ(refusalOfMaterial(R"("density": 1e-6, "restitution": 0, "friction": 0, "rollingResistance": 0,
                                   "spinningResistance": 0, "young": 1e-3, "poisson": -0.99)"),
              "accepted");
    EXPECT_EQ(refusalOfMaterial(R"("density": 1e9, "restitution": 1, "friction": 100, "rollingResistance": 100,
                                   "spinningResistance": 100, "young": 1e15, "poisson": 0.5)"),
              "accepted");
}

TEST(SceneMaterials, AreCheckedEvenIfUnused) {
    EXPECT_EQ(refusalOf(R"("materials": [{}, {"name": "felt"}, {"name": "steel", "restitution": 2}])"),
              "materials[2].restitution: is 2, must be 0 to 1");
}

TEST(SceneMaterials, AreLimitedInNumber) {
    std::string list = R"({"name": "0"})";
    for (std::size_t k = 1; k < maxMaterials; ++k) list += R"(, {"name": ")" + std::to_string(k) + R"("})";
    EXPECT_EQ(sceneWith("\"materials\": [" + list + "]").materials.size(), maxMaterials);
    EXPECT_EQ(refusalOf("\"materials\": [" + list + R"(, {"name": "more"}])"),
              "materials: has 65 entries, must have at most 64");
}

}  // namespace
}  // namespace spherule::scene::testing
