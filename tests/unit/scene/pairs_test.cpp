#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scene/materials.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

constexpr const char* materials = R"("materials": [
    {"name": "felt", "restitution": 0.2, "friction": 0.9, "rollingResistance": 0.04, "spinningResistance": 0.01},
    {"name": "steel", "restitution": 0.8, "friction": 0.1, "rollingResistance": 0.01, "spinningResistance": 0.0025},
    {"name": "ice", "restitution": 0.5, "friction": 0, "rollingResistance": 0, "spinningResistance": 0}])";

Scene withPairs(const std::string& pairs) {
    return sceneWith(fmt::format(R"({}, "pairs": [{}])", materials, pairs));
}

std::string refusalOfPairs(const std::string& pairs) {
    return refusalOf(fmt::format(R"({}, "pairs": [{}])", materials, pairs));
}

TEST(ScenePairs, MaterialWithItselfHasItsOwnParameters) {
    const ContactParameters contact = contactParametersBetween(withPairs(""), 1, 1);
    EXPECT_EQ(contact.restitution, 0.8);
    EXPECT_DOUBLE_EQ(contact.friction, 0.1);
    EXPECT_DOUBLE_EQ(contact.rollingResistance, 0.01);
    EXPECT_DOUBLE_EQ(contact.spinningResistance, 0.0025);
}

TEST(ScenePairs, UseTheSmallerRestitutionAndGeometricMeans) {
    const Scene scene = withPairs("");
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 0)}) {
        const ContactParameters contact =
            contactParametersBetween(scene, static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b));
        EXPECT_EQ(contact.restitution, 0.2);
        EXPECT_DOUBLE_EQ(contact.friction, 0.3);
        EXPECT_DOUBLE_EQ(contact.rollingResistance, 0.02);
        EXPECT_DOUBLE_EQ(contact.spinningResistance, 0.005);
    }
    EXPECT_EQ(contactParametersBetween(scene, 0, 2).friction, 0) << "nothing rubs on what is without friction";
}

TEST(ScenePairs, OverrideGivenPropertiesInBothOrders) {
    const Scene scene = withPairs(R"({"a": "steel", "b": "felt", "restitution": 0.7, "friction": 0})");
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 0)}) {
        const ContactParameters contact =
            contactParametersBetween(scene, static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b));
        EXPECT_EQ(contact.restitution, 0.7);
        EXPECT_EQ(contact.friction, 0);
        EXPECT_DOUBLE_EQ(contact.rollingResistance, 0.02) << "as without the pair";
        EXPECT_DOUBLE_EQ(contact.spinningResistance, 0.005);
    }
    EXPECT_EQ(contactParametersBetween(scene, 0, 0).restitution, 0.2);
    EXPECT_EQ(contactParametersBetween(scene, 1, 1).restitution, 0.8);
    EXPECT_EQ(contactParametersBetween(scene, 1, 2).restitution, 0.5);
}

TEST(ScenePairs, OverrideEveryProperty) {
    const Scene scene = withPairs(R"({"a": "felt", "b": "ice", "rollingResistance": 0.3, "spinningResistance": 0.4},
                                     {"a": "felt", "b": "steel", "restitution": 1, "friction": 100})");
    ASSERT_EQ(scene.pairs.size(), 2U);
    EXPECT_EQ(contactParametersBetween(scene, 0, 2).rollingResistance, 0.3);
    EXPECT_EQ(contactParametersBetween(scene, 0, 2).spinningResistance, 0.4);
    EXPECT_EQ(contactParametersBetween(scene, 0, 1).restitution, 1);
    EXPECT_EQ(contactParametersBetween(scene, 0, 1).friction, 100);
}

TEST(ScenePairs, MayBeOfOneMaterialTwice) {
    const Scene scene = withPairs(R"({"a": "steel", "b": "steel", "friction": 0.6})");
    EXPECT_EQ(contactParametersBetween(scene, 1, 1).friction, 0.6);
    EXPECT_DOUBLE_EQ(contactParametersBetween(scene, 0, 1).friction, 0.3) << "other pairs follow from the materials";
}

TEST(ScenePairs, NameTwoMaterials) {
    EXPECT_EQ(refusalOfPairs("{}"), "pairs[0].a: is missing; give the name of a material");
    EXPECT_EQ(refusalOfPairs(R"({"a": "felt"})"), "pairs[0].b: is missing; give the name of a material");
    EXPECT_EQ(
        refusalOfPairs(R"({"a": "felt", "b": "stell"})"),
        R"(pairs[0].b: is "stell", which is no material of the scene; it has "felt", "steel", "ice"; did you mean "steel"?)");
}

TEST(ScenePairs, AreUnique) {
    EXPECT_EQ(refusalOfPairs(R"({"a": "felt", "b": "steel"}, {"a": "ice", "b": "ice"}, {"a": "steel", "b": "felt"})"),
              R"(pairs[2]: is of "steel" and "felt", as an earlier one is)");
    EXPECT_EQ(refusalOfPairs(R"({"a": "felt", "b": "felt"}, {"a": "felt", "b": "felt"})"),
              R"(pairs[1]: is of "felt" and "felt", as an earlier one is)");
}

TEST(ScenePairs, PropertiesHaveARange) {
    const auto refusalOfPair = [](const std::string& member) {
        return refusalOfPairs(R"({"a": "felt", "b": "steel", )" + member + "}");
    };
    EXPECT_EQ(refusalOfPair(R"("restitution": 1.1)"), "pairs[0].restitution: is 1.1, must be 0 to 1");
    EXPECT_EQ(refusalOfPair(R"("restitution": "NaN")"), "pairs[0].restitution: is nan, must be a finite number");
    EXPECT_EQ(refusalOfPair(R"("friction": -0.1)"), "pairs[0].friction: is -0.1, must be 0 to 100");
    EXPECT_EQ(refusalOfPair(R"("rollingResistance": 101)"), "pairs[0].rollingResistance: is 101, must be 0 to 100");
    EXPECT_EQ(refusalOfPair(R"("spinningResistance": -1)"), "pairs[0].spinningResistance: is -1, must be 0 to 100");
}

}  // namespace
}  // namespace spherule::scene::testing
