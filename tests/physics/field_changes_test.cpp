// Fields that come and go while the simulation runs.
#include <gtest/gtest.h>

#include <algorithm>

#include <fmt/format.h>

#include "part_support.h"
#include "scene/quality.h"

namespace spherule::physics {
namespace {

class FieldChanges : public testing::TestWithParam<Model> {};

INSTANTIATE_TEST_SUITE_P(Of, FieldChanges, testing::Values(Model::Fast, Model::Balanced, Model::Accurate),
                         [](const auto& one) { return std::string(scene::nameOf(one.param)); });

TEST_P(FieldChanges, AFieldFromTheFirstStepOnGivesTheBitsOfAScene) {
    for (const std::string& field : fields) {
        auto written = simulate(fallingBox(GetParam(), R"(, "fields": [)" + field + "]"));
        auto edited = simulate(fallingBox(GetParam()));
        apply(*edited, addField(field));
        EXPECT_EQ(edited->substeps(), written->substeps()) << field;
        EXPECT_EQ(hashAfter(*edited, 0.4), hashAfter(*written, 0.4)) << field;
    }
}

TEST_P(FieldChanges, AFieldThatComesAndGoesLeavesNothing) {
    for (const std::string& field : fields) {
        auto plain = simulate(fallingBox(GetParam()));
        auto edited = simulate(fallingBox(GetParam()));
        apply(*edited, addField(field));
        apply(*edited, change<v1::ChangeField>(fmt::format(R"({{"number": 0, "field": {}}})", fields[2])));
        apply(*edited, removeField(0));
        EXPECT_EQ(edited->plan().features, plain->plan().features) << field;
        EXPECT_EQ(hashAfter(*edited, 0.2), hashAfter(*plain, 0.2)) << field;
    }
}

// A field where no sphere is has no effect on a pile: contacts keep what they hold, and spheres their handles.
TEST_P(FieldChanges, LeaveAPileAlone) {
    scene::Scene scene = fallingBox(GetParam());
    scene.sleep.enabled = false;
    auto simulation = simulate(scene);
    apply(*simulation, sim::Remove{.spheres = {3, 9}});
    run(*simulation, 3);
    const std::uint32_t handle = simulation->population().handleAt(10);
    const double before = simulation->statistics().speedRms;
    apply(*simulation, addField(R"({"drag": {"velocity": [9, 0, 0]}, "inSphere": {"centre": [0, 0, 0.95],
                                    "radius": 0.01}})"));
    EXPECT_EQ(simulation->population().handleAt(10), handle);
    double fastest = 0;
    for (int k = 0; k < 10; ++k) {
        apply(*simulation, k % 2 == 0 ? removeField(0) : addField(fields[1]));
        if (k % 2 != 0) apply(*simulation, removeField(0));
        if (k % 2 != 0)
            apply(*simulation, addField(R"({"drag": {}, "inSphere": {"centre": [0, 0, 0.95],
                                                       "radius": 0.01}})"));
        ASSERT_TRUE(simulation->advance());
        fastest = std::max(fastest, simulation->statistics().speedRms);
    }
    // Without the held impulses, every sphere would fall for a substep.
    const double fall = 9.81 * scene.step / simulation->substeps();
    EXPECT_LT(fastest, std::max(2 * before, 0.2 * fall));
}

// Without contacts, handles and slots differ after a removal.
TEST_P(FieldChanges, SpheresKeepTheirPlacesInASceneWithoutContacts) {
    scene::Scene scene = fallingBox(GetParam());
    scene.sphereContacts = false;
    auto simulation = simulate(scene);
    apply(*simulation, sim::Remove{.spheres = {0, 5, 40}});
    run(*simulation, 0.1);
    const std::uint64_t before = sim::hashOf(simulation->snapshot());
    apply(*simulation, addField(fields[2]));
    EXPECT_EQ(sim::hashOf(simulation->snapshot()), before);
    apply(*simulation, sim::ChangeObstacle{.make = [](const scene::Scene&) -> Result<std::optional<scene::Obstacle>> {
        return obstacleFrom(R"({"sphere": {"centre": [0.3, 0.3, 5], "radius": 0.1}})");
    }});
    EXPECT_EQ(sim::hashOf(simulation->snapshot()), before);
    run(*simulation, 0.1);
    EXPECT_TRUE(allFinite(simulation->snapshot()));
}

TEST_P(FieldChanges, AFieldWakesTheSpheresThatItPushes) {
    if (GetParam() == Model::Accurate) return;  // nothing sleeps
    scene::Scene scene = sleepyBox(2);
    scene.quality.model = GetParam();
    measure::setFriction(scene, 0.5);
    scene.materials[0].rollingResistance = 0.1;
    for (int k = 0; k < 100; ++k)
        measure::addSphere(scene, {-0.8 + 0.17 * (k % 10), -0.8 + 0.17 * (k / 10), -0.95}, 0.05);
    auto simulation = simulate(scene);
    run(*simulation, 3);
    ASSERT_EQ(sleepers(simulation->snapshot()), 100U);
    apply(*simulation, addField(R"({"drag": {}})"));  // air at rest
    EXPECT_EQ(sleepers(simulation->snapshot()), 100U);
    apply(*simulation, addField(R"({"drag": {"velocity": [1, 0, 0]}, "inBox": {"min": [-1, -1, -1],
                                    "max": [0, 0, 1]}})"));
    const sim::State state = simulation->snapshot();
    for (std::uint32_t id = 0; id < 100; ++id) EXPECT_EQ(asleep(state, id), id % 10 > 4 || id / 10 > 4) << id;
    run(*simulation, 3);
    apply(*simulation, removeField(1));  // they rest otherwise without the wind
    EXPECT_LE(sleepers(simulation->snapshot()), 75U);
}

}  // namespace
}  // namespace spherule::physics
