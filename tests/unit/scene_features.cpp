#include "scene/features.h"

#include <gtest/gtest.h>

#include <functional>

#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

// Nothing but two equal spheres that do not bounce.
constexpr const char* bare = R"({"gravity": [0, 0, 0], "restitution": 0, "sleep": {"enabled": false},
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
    Features open = with(&Features::restitution);
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.set_restitution(0.1); }), open);
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.mutable_groups(0)->set_restitution(0.1); }), open);
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.mutable_bounds()->set_restitution(0.1); }), open);
}

TEST(SceneFeatures, RestitutionsDifferBetweenSpheresOnly) {
    Features expected = with(&Features::restitution);
    expected.restitutions = true;
    EXPECT_EQ(featuresAfter([](v1::Scene& s) {
                  *s.add_groups() = s.groups(0);
                  s.mutable_groups(1)->set_restitution(0.7);
              }),
              expected);
}

TEST(SceneFeatures, OneClosedFaceMakesWalls) {
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.mutable_bounds()->mutable_open()->RemoveLast(); }),
              with(&Features::walls));
}

TEST(SceneFeatures, ObstaclesAreOfTwoKinds) {
    const v1::Scene donor = parsed(R"({"obstacles": [{"plane": {"point": [0,0,0], "normal": [0,0,1]}},
        {"box": {"min": [0.8, 0.8, 0.8], "max": [1, 1, 1]}, "restitution": 0.4}]})");
    EXPECT_EQ(featuresAfter([&](v1::Scene& s) { *s.add_obstacles() = donor.obstacles(0); }), with(&Features::planes));
    Features boxes = with(&Features::boxes);
    boxes.restitution = true;
    EXPECT_EQ(featuresAfter([&](v1::Scene& s) { *s.add_obstacles() = donor.obstacles(1); }), boxes);
}

TEST(SceneFeatures, NothingRestsWithoutGravity) {
    EXPECT_EQ(featuresAfter([](v1::Scene& s) { s.clear_sleep(); }), onlyContacts);
}

}  // namespace
}  // namespace spherule::scene::testing
