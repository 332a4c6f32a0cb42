#include "sim/features.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "scene/quality.h"
#include "scene_support.h"
#include "sim/modules/module.h"

namespace spherule::sim {
namespace {

using scene::Model;
using scene::testing::parsed;
using enum Feature;

// A scene of two equal spheres that do not bounce.
constexpr const char* bare =
    R"({"gravity": [0, 0, 0], "materials": [{"name": "clay", "restitution": 0}], "sleep": {"enabled": false},
    "bounds": {"min": [0,0,0], "max": [1,1,1], "open": ["X_MIN", "X_MAX", "Y_MIN", "Y_MAX", "Z_MIN", "Z_MAX"]},
    "groups": [{"list": {"spheres": [{"position": [0.3, 0.3, 0.3]}, {"position": [0.6, 0.6, 0.6]}]},
                "radius": {"constant": 0.1}}]})";

Features featuresAfter(const std::function<void(v1::Scene&)>& change) {
    v1::Scene message = parsed(bare);
    change(message);
    const auto scene = scene::build(message);
    EXPECT_TRUE(scene) << scene.error().text();
    return featuresOf(*scene);
}

v1::Material& add(v1::Scene& scene, const std::string& name) {
    v1::Material& material = *scene.add_materials();
    material.set_name(name);
    material.set_restitution(0);
    return material;
}

v1::MaterialPair& addPair(v1::Scene& scene, const std::string& a, const std::string& b) {
    v1::MaterialPair& pair = *scene.add_pairs();
    pair.set_a(a);
    pair.set_b(b);
    return pair;
}

// Closes the top face with a wall of this material.
void closeTop(v1::Scene& scene, const std::string& material) {
    scene.mutable_bounds()->mutable_open()->RemoveLast();
    scene.mutable_bounds()->set_material(material);
}

using Names = std::vector<std::string>;

Names namesOf(const Features& features) {
    Names names;
    for (const Feature feature : allFeatures())
        if (features.has(feature)) names.emplace_back(nameOf(feature));
    return names;
}

// Returns the features of the bare scene and these further features.
Features bareWith(std::initializer_list<Feature> more) {
    Features features = featuresAfter([](v1::Scene&) {});
    for (const Feature feature : more) features.set(feature);
    return features;
}

TEST(SimFeatures, MinimalSceneHasOnlyContacts) {
    EXPECT_EQ(namesOf(bareWith({})), Names({"contacts", "open faces", "balanced", "contact memory", "impacts"}));
}

TEST(SimFeatures, ContactsDoNotRequireSpheres) {
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.clear_groups(); }), bareWith({}));
    EXPECT_EQ(namesOf(featuresAfter([](v1::Scene& s) { s.set_sphere_contacts(false); })),
              Names({"open faces", "balanced"}));
}

TEST(SimFeatures, GravityRequiresANonZeroVector) {
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.set_gravity(1, 0.5); }), bareWith({Gravity}));
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.clear_gravity(); }), bareWith({Gravity}));
}

TEST(SimFeatures, FieldsRequireAField) {
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.add_fields()->mutable_drag(); }), bareWith({Fields}));
}

TEST(SimFeatures, KindsOfFieldsAreFeaturesOfTheirOwn) {
    const auto with = [](const std::string& field) {
        const v1::Scene more = parsed(R"({"gravity": [0, 0, -1], "fields": [{)" + field + "}]}");
        return featuresAfter([&](v1::Scene& s) {
            s.clear_gravity();
            s.MergeFrom(more);
        });
    };
    EXPECT_EQ(with(R"("attraction": {"centre": [0, 0, 0], "softening": 1})"), bareWith({Gravity, Fields}));
    EXPECT_EQ(with(R"("drag": {"velocity": [0, 0, 0]})"), bareWith({Gravity, Fields}));
    EXPECT_EQ(with(R"("drag": {"velocity": [1, 0, 0]})"), bareWith({Gravity, Fields, Flows}));
    EXPECT_EQ(with(R"("drag": {"vortex": {"centre": [0, 0, 0], "axis": [0, 0, 1], "core": 1}})"),
              bareWith({Gravity, Fields, Flows}));
    EXPECT_EQ(with(R"("buoyancy": {})"), bareWith({Gravity, Fields, Buoyancy}));
    EXPECT_EQ(with(R"("spring": {"centre": [0, 0, 0]})"), bareWith({Gravity, Fields, Springs}));
    EXPECT_EQ(with(R"("drag": {}, "inSphere": {"centre": [0, 0, 0], "radius": 1})"),
              bareWith({Gravity, Fields, Regions}));
}

TEST(SimFeatures, RadiiRequireDifferentRadii) {
    EXPECT_EQ(
        featuresAfter([](v1::Scene& s) { s.mutable_groups(0)->mutable_list()->mutable_spheres(1)->set_radius(0.2); }),
        bareWith({Radii}));
}

TEST(SimFeatures, RestitutionRequiresAPairWithNonZeroRestitution) {
    const Features open = bareWith({Restitution});
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.mutable_materials(0)->set_restitution(0.1); }), open);
    EXPECT_EQ(featuresAfter([](v1::Scene& s) {
                  add(s, "rubber").set_restitution(0.1);
                  s.mutable_groups(0)->set_material("rubber");
              }),
              open);
    Features walls = open;
    walls.set(Walls);
    EXPECT_EQ(featuresAfter([](v1::Scene& s) {
                  add(s, "rubber");
                  closeTop(s, "rubber");
                  addPair(s, "clay", "rubber").set_restitution(0.1);
              }),
              walls);
}

TEST(SimFeatures, RestitutionIsTheSmallerOneOfAPair) {
    EXPECT_EQ(featuresAfter([](v1::Scene& s) {
                  add(s, "rubber").set_restitution(0.9);
                  closeTop(s, "rubber");
              }),
              bareWith({Walls}))
        << "the smaller of the two counts";
}

TEST(SimFeatures, OpenFacesHaveNoMaterial) {
    const auto rubber = [](v1::Scene& s) {
        add(s, "rubber");
        v1::MaterialPair& pair = addPair(s, "clay", "rubber");
        pair.set_restitution(0.1);
        pair.set_friction(0.1);
        s.mutable_bounds()->set_material("rubber");
    };
    EXPECT_EQ(featuresAfter(rubber), bareWith({}));
    EXPECT_TRUE(featuresAfter([&](v1::Scene& s) {
                    rubber(s);
                    s.mutable_bounds()->mutable_open()->RemoveLast();
                }).has(Friction));
}

TEST(SimFeatures, MaterialsRequireSpheresOfDifferentMaterials) {
    Features expected = bareWith({Restitution});
    expected.set(Materials);
    EXPECT_EQ(featuresAfter([](v1::Scene& s) {
                  *s.add_groups() = s.groups(0);
                  add(s, "rubber").set_restitution(0.7);
                  s.mutable_groups(1)->set_material("rubber");
              }),
              expected);
}

TEST(SimFeatures, OneClosedFaceAddsWalls) {
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.mutable_bounds()->mutable_open()->RemoveLast(); }), bareWith({Walls}));
}

TEST(SimFeatures, EachShapeOfAnObstacleIsAFeature) {
    const v1::Scene donor = parsed(R"({"obstacles": [{"plane": {"point": [0,0,0], "normal": [0,0,1]}},
        {"box": {"min": [0.8, 0.8, 0.8], "max": [1, 1, 1]}, "material": "rubber"},
        {"sphere": {"centre": [0.9, 0.9, 0.9], "radius": 0.1}},
        {"cylinder": {"from": [0.8, 0.9, 0.9], "to": [1, 0.9, 0.9], "radius": 0.1}}]})");
    EXPECT_EQ(featuresAfter([&](v1::Scene& s) { *s.add_obstacles() = donor.obstacles(0); }),
              bareWith({Obstacles, Planes}));
    EXPECT_EQ(featuresAfter([&](v1::Scene& s) { *s.add_obstacles() = donor.obstacles(2); }),
              bareWith({Obstacles, SphereObstacles}));
    EXPECT_EQ(featuresAfter([&](v1::Scene& s) { *s.add_obstacles() = donor.obstacles(3); }),
              bareWith({Obstacles, Cylinders}));
    Features boxes = bareWith({Obstacles, Boxes});
    boxes.set(Restitution);
    EXPECT_EQ(featuresAfter([&](v1::Scene& s) {
                  *s.add_obstacles() = donor.obstacles(1);
                  add(s, "rubber");
                  addPair(s, "rubber", "clay").set_restitution(0.4);
              }),
              boxes);
}

TEST(SimFeatures, SleepNeedsGravity) {
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.clear_sleep(); }), bareWith({}));
}

TEST(SimFeatures, ModelComesFromTheScene) {
    const std::pair<Model, Names> cases[] = {
        {Model::Fast, {"contacts", "open faces", "fast", "impacts"}},
        {Model::Balanced, {"contacts", "open faces", "balanced", "contact memory", "impacts"}},
        {Model::Accurate, {"contacts", "open faces", "accurate", "low bits"}}};
    for (const auto& [model, names] : cases)
        EXPECT_EQ(
            namesOf(featuresAfter([&](v1::Scene& s) { s.mutable_quality()->set_model(scene::messageOf(model)); })),
            names);
}

TEST(SimFeatures, EachHasAModule) {
    for (const Feature feature : allFeatures())
        EXPECT_EQ(modules().at(static_cast<std::size_t>(feature))->feature, feature) << nameOf(feature);
}

TEST(SimFeatures, EachHasACostRowOrAReasonForNone) {
    for (const Module* module : modules())
        EXPECT_NE(module->cost.name.empty(), module->cost.reason.empty()) << nameOf(module->feature);
}

TEST(SimFeatures, CostComparisonsSwitchTheFeature) {
    v1::Scene bed = parsed(bare);
    bed.mutable_bounds()->clear_open();
    bed.clear_gravity();
    const auto scene = scene::build(bed);
    ASSERT_TRUE(scene) << scene.error().text();
    for (const Module* module : modules()) {
        const CostComparison& cost = module->cost;
        if (cost.name.empty() || module->feature == Feature::Impacts) continue;  // observing needs no other scene
        scene::Scene without = *scene;
        scene::Scene with = *scene;
        if (cost.without != nullptr) cost.without(without);
        if (cost.with != nullptr) cost.with(with);
        EXPECT_FALSE(featuresOf(without).has(module->feature)) << cost.name;
        EXPECT_TRUE(featuresOf(with).has(module->feature)) << cost.name;
    }
}

TEST(SimFeatures, OnlyAccurateFollowsHertz) {
    for (const Model model : {Model::Fast, Model::Balanced, Model::Accurate}) {
        const Features features = featuresAfter([&](v1::Scene& s) {
            s.mutable_quality()->set_model(scene::messageOf(model));
            s.mutable_materials(0)->set_young(1e7);
        });
        EXPECT_EQ(features.has(Hertz), model == Model::Accurate) << scene::nameOf(model);
    }
}

TEST(SimFeatures, AccurateHasNoSleep) {
    for (const Model model : {Model::Fast, Model::Balanced, Model::Accurate}) {
        const Features features = featuresAfter([&](v1::Scene& s) {
            s.mutable_quality()->set_model(scene::messageOf(model));
            s.clear_gravity();
            s.clear_sleep();
        });
        EXPECT_EQ(features.has(Sleep), model != Model::Accurate) << scene::nameOf(model);
    }
}

// The features that friction and rolling resistance require.

// Returns the features of two spheres of the material "ball" in a closed cube of "wall". `more`: further members.
Features featuresWith(const std::string& ball, const std::string& wall, const std::string& more = "") {
    const auto scene =
        scene::build(parsed(R"({"bounds": {"min": [0,0,0], "max": [1,1,1], "material": "wall"}, "groups": [
        {"list": {"spheres": [{"position": [0.3, 0.3, 0.3]}, {"position": [0.6, 0.6, 0.6]}]},
         "radius": {"constant": 0.1}, "material": "ball"}],
        "materials": [{"name": "ball", )" +
                            ball + R"(}, {"name": "wall", )" + wall + "}]" + more + "}"));
    EXPECT_TRUE(scene) << scene.error().text();
    return featuresOf(*scene);
}

constexpr const char* smooth = R"("friction": 0)";
constexpr const char* rough = R"("friction": 0.5)";
constexpr const char* apart = R"(, "sphereContacts": false)";

std::string pairOf(const std::string& a, const std::string& b, const std::string& members) {
    return R"(, "pairs": [{"a": ")" + a + R"(", "b": ")" + b + R"(", )" + members + "}]";
}

TEST(SimFriction, RequiresFrictionBetweenSpheres) {
    EXPECT_FALSE(featuresWith(smooth, smooth).has(Feature::Friction));
    EXPECT_TRUE(featuresWith(rough, smooth).has(Feature::Friction));
    EXPECT_FALSE(featuresWith(rough, smooth, apart).has(Feature::Friction)) << "they never meet";
}

TEST(SimFriction, CountsForPairsOfWallAndSphere) {
    EXPECT_TRUE(featuresWith(rough, rough, apart).has(Feature::Friction));
    EXPECT_FALSE(featuresWith(smooth, rough).has(Feature::Friction)) << "the geometric mean is zero";
    EXPECT_TRUE(featuresWith(smooth, smooth, pairOf("wall", "ball", rough)).has(Feature::Friction));
    EXPECT_TRUE(featuresWith(smooth, rough, pairOf("ball", "wall", rough)).has(Feature::Friction));
    EXPECT_FALSE(featuresWith(rough, rough, apart + pairOf("ball", "wall", smooth)).has(Feature::Friction));
}

TEST(SimFriction, CountsForPairsOfObstacleAndSphere) {
    const std::string plate = R"(, "obstacles": [{"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}, "material": )";
    EXPECT_TRUE(featuresWith(rough, smooth, apart + plate + R"("ball"}])").has(Feature::Friction));
    EXPECT_FALSE(featuresWith(rough, smooth, apart + plate + R"("wall"}])").has(Feature::Friction));
}

TEST(SimFriction, IgnoresMaterialsWithoutSpheres) {
    EXPECT_FALSE(featuresWith(smooth, smooth, pairOf("wall", "wall", rough)).has(Feature::Friction))
        << "a wall meets no wall";
    const Features features = featuresOf(
        scene::testing::sceneWith(R"("materials": [{"restitution": 0},
        {"name": "felt", "restitution": 0.9, "friction": 0.9, "rollingResistance": 0.9, "young": 1e7}], )" +
                                  scene::testing::group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.5]}]},
                                                            "radius": {"constant": 0.1})")));
    EXPECT_FALSE(features.has(Feature::Friction));
    EXPECT_FALSE(features.has(Feature::Rolling));
    EXPECT_FALSE(features.has(Feature::Restitution));
    EXPECT_FALSE(features.has(Feature::Materials));
    EXPECT_FALSE(features.has(Feature::Hertz));
}

TEST(SimFriction, RollingResistanceNeedsFriction) {
    const std::string rolling = R"(, "rollingResistance": 0.1)";
    const std::string spinning = R"(, "spinningResistance": 0.1)";
    EXPECT_FALSE(featuresWith(rough, rough).has(Feature::Rolling));
    for (const std::string& resistance : {rolling, spinning}) {
        EXPECT_TRUE(featuresWith(rough + resistance, smooth).has(Feature::Rolling));
        EXPECT_FALSE(featuresWith(smooth + resistance, smooth + resistance).has(Feature::Rolling)) << "nothing turns";
        EXPECT_FALSE(featuresWith(rough, rough + resistance).has(Feature::Rolling)) << "the geometric mean is zero";
        EXPECT_TRUE(featuresWith(rough, rough, pairOf("ball", "wall", resistance.substr(2))).has(Feature::Rolling));
    }
}

}  // namespace
}  // namespace spherule::sim
