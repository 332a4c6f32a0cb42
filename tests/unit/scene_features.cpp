#include "scene/features.h"

#include <gtest/gtest.h>

#include <functional>

#include "scene/quality.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

// Nothing but two equal spheres that do not bounce.
constexpr const char* bare =
    R"({"gravity": [0, 0, 0], "materials": [{"name": "clay", "restitution": 0}], "sleep": {"enabled": false},
    "bounds": {"min": [0,0,0], "max": [1,1,1], "open": ["X_MIN", "X_MAX", "Y_MIN", "Y_MAX", "Z_MIN", "Z_MAX"]},
    "groups": [{"list": {"spheres": [{"position": [0.3, 0.3, 0.3]}, {"position": [0.6, 0.6, 0.6]}]},
                "radius": {"constant": 0.1}}]})";

Features featuresAfter(const std::function<void(v1::Scene&)>& change) {
    v1::Scene message = parsed(bare);
    change(message);
    const auto scene = build(message);
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

// Makes the uppermost face a wall of this material.
void closeTop(v1::Scene& scene, const std::string& material) {
    scene.mutable_bounds()->mutable_open()->RemoveLast();
    scene.mutable_bounds()->set_material(material);
}

const Features onlyContacts{.contacts = true};

Features with(bool Features::*feature) {
    Features features = onlyContacts;
    features.*feature = true;
    return features;
}

TEST(SceneFeatures, ABareSceneHasOnlyContacts) {
    EXPECT_EQ(featuresAfter([](v1::Scene&) {}), onlyContacts);
}

TEST(SceneFeatures, ContactsAreKeptForSpheresToCome) {
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.clear_groups(); }), onlyContacts);
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.set_sphere_contacts(false); }), Features{});
}

TEST(SceneFeatures, GravityIsWhatIsNotZero) {
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.set_gravity(1, 0.5); }), with(&Features::gravity));
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.clear_gravity(); }), with(&Features::gravity));
}

TEST(SceneFeatures, RadiiMayDiffer) {
    EXPECT_EQ(
        featuresAfter([](v1::Scene& s) { s.mutable_groups(0)->mutable_list()->mutable_spheres(1)->set_radius(0.2); }),
        with(&Features::radii));
}

TEST(SceneFeatures, RestitutionIsAnythingThatBounces) {
    const Features open = with(&Features::restitution);
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.mutable_materials(0)->set_restitution(0.1); }), open);
    EXPECT_EQ(featuresAfter([](v1::Scene& s) {
                  add(s, "rubber").set_restitution(0.1);
                  s.mutable_groups(0)->set_material("rubber");
              }),
              open);
    Features walls = open;
    walls.walls = true;
    EXPECT_EQ(featuresAfter([](v1::Scene& s) {
                  add(s, "rubber");
                  closeTop(s, "rubber");
                  addPair(s, "clay", "rubber").set_restitution(0.1);
              }),
              walls);
}

TEST(SceneFeatures, NothingBouncesOffWhatDoesNot) {
    EXPECT_EQ(featuresAfter([](v1::Scene& s) {
                  add(s, "rubber").set_restitution(0.9);
                  closeTop(s, "rubber");
              }),
              with(&Features::walls))
        << "the smaller of the two counts";
}

TEST(SceneFeatures, OpenFacesAreOfNoMaterial) {
    const auto rubber = [](v1::Scene& s) {
        add(s, "rubber");
        v1::MaterialPair& pair = addPair(s, "clay", "rubber");
        pair.set_restitution(0.1);
        pair.set_friction(0.1);
        s.mutable_bounds()->set_material("rubber");
    };
    EXPECT_EQ(featuresAfter(rubber), onlyContacts);
    EXPECT_TRUE(featuresAfter([&](v1::Scene& s) {
                    rubber(s);
                    s.mutable_bounds()->mutable_open()->RemoveLast();
                }).friction);
}

TEST(SceneFeatures, MaterialsDifferBetweenSpheresOnly) {
    Features expected = with(&Features::restitution);
    expected.materials = true;
    EXPECT_EQ(featuresAfter([](v1::Scene& s) {
                  *s.add_groups() = s.groups(0);
                  add(s, "rubber").set_restitution(0.7);
                  s.mutable_groups(1)->set_material("rubber");
              }),
              expected);
}

TEST(SceneFeatures, OneClosedFaceMakesWalls) {
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.mutable_bounds()->mutable_open()->RemoveLast(); }),
              with(&Features::walls));
}

TEST(SceneFeatures, ObstaclesAreOfTwoKinds) {
    const v1::Scene donor = parsed(R"({"obstacles": [{"plane": {"point": [0,0,0], "normal": [0,0,1]}},
        {"box": {"min": [0.8, 0.8, 0.8], "max": [1, 1, 1]}, "material": "rubber"}]})");
    EXPECT_EQ(featuresAfter([&](v1::Scene& s) { *s.add_obstacles() = donor.obstacles(0); }), with(&Features::planes));
    Features boxes = with(&Features::boxes);
    boxes.restitution = true;
    EXPECT_EQ(featuresAfter([&](v1::Scene& s) {
                  *s.add_obstacles() = donor.obstacles(1);
                  add(s, "rubber");
                  addPair(s, "rubber", "clay").set_restitution(0.4);
              }),
              boxes);
}

TEST(SceneFeatures, NothingRestsWithoutGravity) {
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.clear_sleep(); }), onlyContacts);
}

TEST(SceneFeatures, TheModelIsTheScenes) {
    for (const Model model : {Model::Fast, Model::Balanced, Model::Accurate}) {
        Features expected = onlyContacts;
        expected.model = model;
        EXPECT_EQ(featuresAfter([&](v1::Scene& s) { s.mutable_quality()->set_model(messageOf(model)); }), expected);
    }
}

TEST(SceneFeatures, OnlyAccurateFollowsHertz) {
    for (const Model model : {Model::Fast, Model::Balanced, Model::Accurate}) {
        const Features features = featuresAfter([&](v1::Scene& s) {
            s.mutable_quality()->set_model(messageOf(model));
            s.mutable_materials(0)->set_young(1e7);
        });
        EXPECT_EQ(features.hertz, model == Model::Accurate) << nameOf(model);
    }
}

TEST(SceneFeatures, NothingSleepsUnderAccurate) {
    for (const Model model : {Model::Fast, Model::Balanced, Model::Accurate}) {
        const Features features = featuresAfter([&](v1::Scene& s) {
            s.mutable_quality()->set_model(messageOf(model));
            s.clear_gravity();
            s.clear_sleep();
        });
        EXPECT_EQ(features.sleep, model != Model::Accurate) << nameOf(model);
    }
}

}  // namespace
}  // namespace spherule::scene::testing
