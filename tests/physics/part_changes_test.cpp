// Emitters, materials and groups that change while the simulation runs.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "part_support.h"
#include "scene/materials.h"
#include "scene/quality.h"

namespace spherule::physics {
namespace {

class PartChanges : public testing::TestWithParam<Model> {};

INSTANTIATE_TEST_SUITE_P(Of, PartChanges, testing::Values(Model::Fast, Model::Balanced, Model::Accurate),
                         [](const auto& one) { return std::string(scene::nameOf(one.param)); });

TEST_P(PartChanges, AnEmitterFromTheFirstStepOnGivesTheBitsOfAScene) {
    auto written = simulate(emptyBox(jet, GetParam()));
    auto edited = simulate(emptyBox("", GetParam()));
    apply(*edited, change<v1::AddEmitter>(fmt::format(R"({{"emitter": {}}})", jet)));
    EXPECT_EQ(hashAfter(*edited, 1), hashAfter(*written, 1));
    EXPECT_GT(edited->count(), 50U);
    EXPECT_EQ(described(*edited), described(*written));
}

// An emitter that comes later works as in a scene that begins later.
TEST_P(PartChanges, TimesOfAnEmitterCountFromWhenItComes) {
    auto written = simulate(emptyBox(jet, GetParam()));
    auto edited = simulate(emptyBox("", GetParam()));
    run(*edited, 0.5);
    apply(*edited, change<v1::AddEmitter>(fmt::format(R"({{"emitter": {}}})", jet)));
    run(*edited, 0.5);
    run(*written, 0.5);
    EXPECT_NEAR(static_cast<double>(edited->population().born()), static_cast<double>(written->population().born()), 1);
}

TEST_P(PartChanges, OtherEmittersGoOnAsIfNothingHappened) {
    const std::string small =
        R"({"name": "rain", "box": {"min": [-0.5, -0.5, 0.9], "max": [0.5, 0.5, 0.95]}, "rate": 40,
                                  "radius": {"uniform": {"min": 0.02, "max": 0.03}}})";
    auto plain = simulate(emptyBox(std::string(jet) + "," + small, GetParam()));
    auto edited = simulate(emptyBox(std::string(jet) + "," + small, GetParam()));
    run(*plain, 0.5);
    run(*edited, 0.5);
    const auto before = edited->statistics().emitters;
    apply(*edited, change<v1::RemoveEmitter>(R"({"number": 0})"));
    const auto after = edited->statistics().emitters;
    ASSERT_EQ(after.size(), 1U);
    EXPECT_EQ(after[0].name, "rain");
    EXPECT_EQ(after[0].born.spheres, before[1].born.spheres);
    // The same radii, in the same order.
    run(*plain, 0.5);
    run(*edited, 0.5);
    const auto radiiOf = [](sim::Simulation& simulation) {
        std::vector<float> radii;
        const auto& scene = simulation.scene();
        for (const scene::Sphere& sphere : scene.spheres)
            if (scene.groups[sphere.group].name == "rain") radii.push_back(sphere.radius);
        return radii;
    };
    const auto [mine, theirs] = std::pair(radiiOf(*edited), radiiOf(*plain));
    ASSERT_GT(mine.size(), 30U);
    for (std::size_t k = 0; k < std::min(mine.size(), theirs.size()) - 5; ++k) EXPECT_EQ(mine[k], theirs[k]) << k;
    // A new one has random numbers of its own.
    apply(*edited, change<v1::AddEmitter>(fmt::format(R"({{"emitter": {}}})", small)));
    EXPECT_NE(edited->scene().emitters[0].stream, edited->scene().emitters[1].stream);
}

TEST_P(PartChanges, AChangedEmitterKeepsItsCounts) {
    auto simulation = simulate(emptyBox(jet, GetParam()));
    run(*simulation, 0.5);
    const std::uint64_t before = simulation->statistics().emitters[0].born.spheres;
    std::string other(jet);
    other.replace(other.find("\"rate\": 90"), 10, "\"rate\": 9, \"colour\": \"#ff0000\"");
    apply(*simulation, change<v1::ChangeEmitter>(fmt::format(R"({{"number": 0, "emitter": {}}})", other)));
    EXPECT_EQ(simulation->statistics().emitters[0].born.spheres, before);
    ASSERT_EQ(simulation->scene().groups.size(), 2U) << "new spheres look otherwise";
    EXPECT_EQ(simulation->scene().groups[0].count, before);
    run(*simulation, 1);
    EXPECT_NEAR(simulation->scene().groups[1].count, 9, 1);
    EXPECT_EQ(simulation->scene().groups[0].count, before);
}

constexpr const char* three = R"({"name": "steel", "density": 7800, "friction": 0.2}, {"name": "unused"},
                                 {"name": "cork", "density": 240, "friction": 0.6})";

TEST_P(PartChanges, AMaterialOfAGroupFromTheFirstStepOnGivesTheBitsOfAScene) {
    scene::Scene scene = fallingBox(GetParam(), "", three);
    for (scene::Sphere& sphere : scene.spheres)
        if (sphere.group == 1) sphere.material = 2;
    scene.groups[1].material = 2;
    ASSERT_TRUE(scene::fitSubsteps(scene));
    auto written = simulate(scene);
    auto edited = simulate(fallingBox(GetParam(), "", three));
    apply(*edited, change<v1::ChangeGroup>(R"({"number": 1, "material": "cork", "name": "floats"})"));
    EXPECT_EQ(edited->scene().groups[1].name, "floats");
    EXPECT_EQ(hashAfter(*edited, 0.4), hashAfter(*written, 0.4));
    EXPECT_DOUBLE_EQ(edited->statistics().potentialEnergy, written->statistics().potentialEnergy);
    // And so does the removal of the material between them.
    apply(*edited, change<v1::RemoveMaterial>(R"({"number": 1})"));
    EXPECT_EQ(edited->scene().materials.size(), 2U);
    EXPECT_EQ(hashAfter(*edited, 0.2), hashAfter(*written, 0.2));
}

TEST_P(PartChanges, AMaterialChangesMassAndFriction) {
    scene::Scene scene = fineStepBox(2);
    scene.quality = {.model = GetParam(), .substeps = GetParam() == Model::Accurate ? 50U : 1U};
    setRestitution(scene, 0);
    measure::addSphere(scene, {0, 0, -0.95}, 0.05);
    scene.spheres[0].velocity = {1, 0, 0};
    auto simulation = simulate(scene);
    run(*simulation, 0.2);
    sim::State state = simulation->snapshot();
    EXPECT_NEAR(velocityOf(state, 0).x, 1, 1e-3) << "it slides";
    apply(*simulation, change<v1::ChangeMaterial>(R"({"number": 0, "material": {"friction": 0.5, "density": 3000,
                                         "restitution": 0}})"));
    const double mass = 3000 * 4.0 / 3 * std::acos(-1) * 0.05 * 0.05 * 0.05;
    EXPECT_NEAR(massOf(simulation->snapshot(), 0), mass, 1e-6 * mass);
    run(*simulation, 0.5);
    state = simulation->snapshot();
    EXPECT_NEAR(velocityOf(state, 0).x, 5.0 / 7, 0.02) << "it rolls";
    EXPECT_NEAR(spinOf(state, 0).y, 5.0 / 7 / 0.05, 0.5);
}

TEST(PartChange, OfAMaterialInUseIsRefused) {
    auto simulation = simulate(sceneOf(R"({"bounds": {"min": [0, 0, 0], "max": [1, 1, 1], "material": "wall"},
        "materials": [{"name": "wall"}, {"name": "glass"}, {"name": "wood"}, {"name": "air"}],
        "obstacles": [{"sphere": {"centre": [0.5, 0.5, 0.2], "radius": 0.1}, "material": "wood"}],
        "groups": [{"list": {"spheres": [{"position": [0.5, 0.5, 0.6]}]}, "radius": {"constant": 0.1},
                    "material": "glass"}]})"));
    const auto remove = [&](unsigned number) {
        return refusalOf(*simulation, change<v1::RemoveMaterial>(fmt::format(R"({{"number": {}}})", number)));
    };
    const std::string hint = "; remove these, or change their material";
    EXPECT_EQ(remove(0), R"(number: is of the material "wall", of which are the walls)" + hint);
    EXPECT_EQ(remove(1), R"(number: is of the material "glass", of which are groups[0])" + hint);
    EXPECT_EQ(remove(2), R"(number: is of the material "wood", of which are obstacles[0])" + hint);
    EXPECT_EQ(remove(4), "number: is 4, must be 0 to 3");
    EXPECT_EQ(remove(3), "applied");
    EXPECT_EQ(refusalOf(*simulation, change<v1::SetPair>(R"({"pair": {"a": "wall", "b": "air", "friction": 1}})")),
              R"(pair.b: is "air", which is no material of the scene; it has "wall", "glass", "wood")");
    EXPECT_EQ(refusalOf(*simulation, change<v1::SetPair>(R"({"pair": {"a": "wall", "b": "glass", "friction": 1}})")),
              "applied");
    EXPECT_EQ(scene::contactParametersBetween(simulation->scene(), 1, 0).friction, 1);
    EXPECT_EQ(refusalOf(*simulation, change<v1::AddMaterial>(R"({"material": {"name": "wood"}})")),
              R"(material.name: is "wood", the name of another material)");
    EXPECT_EQ(refusalOf(*simulation, change<v1::ChangeMaterial>(R"({"number": 1, "material": {"name": ""}})")),
              "material.name: is missing; only the first material may go without");
    EXPECT_EQ(refusalOf(*simulation, sim::RemoveGroup{0}), "applied");
    EXPECT_EQ(simulation->count(), 0U);
    EXPECT_EQ(remove(1), "applied");
    EXPECT_TRUE(simulation->scene().pairs.empty());
}

TEST(PartChange, KeepsTheNamesOfPairs) {
    auto simulation = simulate(fallingBox(Model::Balanced, R"(, "pairs": [{"a": "oak", "b": "cork", "friction": 1}])",
                                          R"({"name": "oak"}, {"name": "cork"})"));
    EXPECT_EQ(refusalOf(*simulation, change<v1::ChangeMaterial>(R"({"number": 0, "material": {"friction": 0.3}})")),
              "material.name: is empty, but pairs[0] is of this material; give it a name, or remove the pair first");
    apply(*simulation, change<v1::SetPair>(R"({"pair": {"a": "oak", "b": "cork"}})"));
    apply(*simulation, change<v1::ChangeMaterial>(R"({"number": 0, "material": {"friction": 0.3}})"));
}

// A state that is not finite is not kept as the last good one.
TEST(PartChange, IsRefusedBesideANonFiniteSphere) {
    scene::Scene scene = fallingBox(Model::Fast);
    scene.quality.substeps = 8;
    auto simulation = simulate(scene);
    run(*simulation, 0.1);
    const std::uint64_t good = simulation->steps();
    sim::State broken = simulation->snapshot();
    broken.velocity[0].x = std::numeric_limits<float>::quiet_NaN();
    simulation->upload(broken);
    ASSERT_TRUE(simulation->advance());
    ASSERT_TRUE(simulation->advance());
    ASSERT_TRUE(simulation->midStep());
    const std::string why =
        "a sphere has no finite position any more; change the scene after it has gone back to its last good state";
    EXPECT_EQ(refusalOf(*simulation, addField(fields[0])), why);
    EXPECT_EQ(refusalOf(*simulation, change<v1::ChangeGroup>(R"({"number": 0, "name": "g"})")), why);
    EXPECT_EQ(refusalOf(*simulation, sim::RemoveGroup{0}), why);
    simulation->rollback();
    EXPECT_LE(simulation->steps(), good);
    apply(*simulation, addField(fields[0]));
    run(*simulation, 0.1);
    EXPECT_EQ(simulation->statistics().nonFinite, 0U);
}

// Spheres that are added when a scene has its most groups take the place of an empty group. The others keep theirs.
TEST(PartChange, KeepsGroupsAtTheirLimit) {
    std::string groups;
    for (std::size_t k = 0; k < scene::maxGroups; ++k)
        groups +=
            fmt::format(R"({}{{"name": "g{}", "radius": {{"constant": 0.1}}, "list": {{"spheres": [{{"position":
                              [{}, {}, 1]}}]}}}})",
                        k == 0 ? "" : ",", k, 0.5 + static_cast<double>(k % 100), 0.5 + static_cast<double>(k / 100));
    auto simulation = simulate(sceneOf(fmt::format(
        R"({{"bounds": {{"min": [0, 0, 0], "max": [101, 101, 2]}}, "sphereContacts": false, "quality": {{"model": "FAST"}},
             "groups": [{}]}})",
        groups)));
    apply(*simulation, sim::Remove{.spheres = {100}});
    apply(*simulation,
          sim::Spawn{.name = "new", .place = [](const scene::Scene& now, Progress&) {
                         return std::vector<scene::Sphere>{{.position = glm::dvec3(50, 50, 1.5),
                                                            .radius = 0.1F,
                                                            .group = static_cast<std::uint16_t>(now.groups.size())}};
                     }});
    const scene::Scene& scene = simulation->scene();
    ASSERT_EQ(scene.groups.size(), scene::maxGroups);
    std::vector<std::uint32_t> counts(scene.groups.size());
    for (std::uint32_t rank = 0; rank < simulation->count(); ++rank) {
        const std::uint64_t id = simulation->population().idAt(rank);
        const std::uint16_t group = scene.spheres[rank].group;
        ASSERT_EQ(scene.groups.at(group).name, id < scene::maxGroups ? fmt::format("g{}", id) : "new") << id;
        ++counts[group];
    }
    for (std::size_t k = 0; k < counts.size(); ++k) ASSERT_EQ(scene.groups[k].count, counts[k]) << k;
}

TEST(PartChange, IsCheckedWithTheWholeScene) {
    auto simulation = simulate(fallingBox(Model::Balanced));
    for (int k = 0; k < 8; ++k) apply(*simulation, addField(R"({"drag": {}})"));
    EXPECT_EQ(refusalOf(*simulation, addField(R"({"drag": {}})")), "field: is one too many, a scene has at most 8");
    EXPECT_EQ(refusalOf(*simulation, change<v1::ChangeField>(R"({"number": 2, "field": {"drag": {"density": -1}}})")),
              "field.drag.density: is -1, must be 0 to 100000 kg/m^3");
    EXPECT_EQ(refusalOf(*simulation, change<v1::ChangeField>(R"({"number": 9})")), "number: is 9, must be 0 to 7");
    apply(*simulation, removeField(0));
    apply(*simulation, sim::Set{.gravity = glm::dvec3(0)});
    EXPECT_NE(refusalOf(*simulation, addField(R"({"buoyancy": {}})")).find("gravity"), std::string::npos);
    const std::string flow = R"({"emitter": {"box": {"min": [-0.5, -0.5, 0.6], "max": [0.5, 0.5, 1]}, "rate": 200000,
                                 "radius": {"constant": 0.001}}})";
    apply(*simulation, change<v1::AddEmitter>(flow));
    EXPECT_NE(refusalOf(*simulation, change<v1::AddEmitter>(flow)).find("emitter: brings the emitters to 6666.67"),
              std::string::npos);
}

// A change may not make a step take minutes. A written scene may.
TEST(PartChange, ThatNeedsVeryManySubstepsIsRefused) {
    auto simulation = simulate(emptyBox(R"({"box": {"min": [-0.5, -0.5, 0.6], "max": [0.5, 0.5, 1]}, "rate": 100,
                                            "radius": {"constant": 0.001}})",
                                        Model::Balanced));
    const auto spring = [](double stiffness) {
        return addField(fmt::format(R"({{"spring": {{"centre": [0, 0, 0], "stiffness": {}}}}})", stiffness));
    };
    const std::string before = described(*simulation);
    const std::uint32_t substeps = simulation->substeps();
    const std::string refusal = refusalOf(*simulation, spring(100));
    EXPECT_NE(refusal.find(fmt::format("quality.substeps: would rise from {} to ", substeps)), std::string::npos)
        << refusal;
    EXPECT_NE(refusal.find("at most 20000 are allowed"), std::string::npos) << refusal;
    EXPECT_EQ(described(*simulation), before);
    EXPECT_EQ(simulation->substeps(), substeps);
    apply(*simulation, spring(2));
    EXPECT_LE(simulation->substeps(), 20000U);
    EXPECT_GT(simulation->substeps(), 10000U);
}

}  // namespace
}  // namespace spherule::physics
