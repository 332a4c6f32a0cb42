#include "host/scene_saver.h"

#include <gtest/gtest.h>

#include <future>
#include <string>
#include <thread>

#include <glm/geometric.hpp>

#include "compute/device.h"
#include "scene/build.h"
#include "scene/json.h"
#include "scene/shapes.h"
#include "sim/simulation.h"

namespace spherule::host {
namespace {

using namespace std::chrono_literals;

// Has a feature of each kind. Obstacles of other shapes do not go with periodic axes.
constexpr const char* full = R"({
  "name": "full \"quoted\"", "description": "everything", "gravity": [0.5, 0, -9.81], "step": 0.01,
  "bounds": {"min": [100, 0, 0], "max": [104, 4, 3], "open": ["Z_MAX"], "periodic": ["X"], "material": "steel"},
  "materials": [
    {"name": "glass", "density": 2500, "restitution": 0.7, "friction": 0.2},
    {"name": "steel", "density": 7800, "restitution": 0.6, "friction": 0.4, "rollingResistance": 0.01}
  ],
  "pairs": [{"a": "glass", "b": "steel", "restitution": 0.65}],
  "obstacles": [{"plane": {"point": [102, 4, 0], "normal": [0, -0.2, 1]}, "material": "steel", "colour": "#102030"}],
  "fields": [{"drag": {"density": 2, "velocity": [0.1, 0, 0], "vortex":
    {"centre": [0, 2, 1], "axis": [1, 0, 0], "speed": -0.2, "core": 0.5}}, "inBox": {"min": [0, 1, 0], "max": [200, 3, 2]}}],
  "sinks": [{"region": {"min": [100, 0, -1], "max": [100.5, 0.5, 0.2]}}],
  "sleep": {"speed": 0.03, "time": 0.7},
  "quality": {"model": "BALANCED", "substeps": 6, "auto": {"overlap": 0.01}},
  "camera": {"eye": [102, -8, 3], "target": [102, 2, 1], "fieldOfView": 35},
  "groups": [
    {"name": "grains", "fill": {"min": [100, 0, 1], "max": [104, 4, 2.5], "count": 300},
     "radius": {"uniform": {"min": 0.05, "max": 0.08}}, "material": "glass", "velocity": [1, 0, 0], "spin": [0, 2, 0],
     "colour": "#ff0000", "roughness": 0.2},
    {"name": "posts", "list": {"spheres": [{"position": [100.7, 2, 0.5]}, {"position": [103.5, 1, 0.5]}]},
     "radius": {"constant": 0.2}, "material": "steel", "fixed": true, "metal": 1}
  ]
})";

std::string withoutPeriodicAxis() {
    std::string text = full;
    const auto replace = [&](const std::string& before, const std::string& after) {
        text.replace(text.find(before), before.size(), after);
    };
    replace(R"("periodic": ["X"], )", "");
    replace(R"("fields": [)",
            R"("fields": [{"attraction": {"centre": [102, 2, 1], "strength": 0.5, "softening": 0.2}},
      {"buoyancy": {"density": 300, "surface": [0, 0, 1]}, "inSphere": {"centre": [102, 2, 1], "radius": 1}},
      {"spring": {"centre": [101, 2, 1], "stiffness": 2, "damping": 0.1},
       "inCylinder": {"from": [103, 3, 0], "to": [103, 3, 3], "radius": 1}}, )");
    replace(R"("obstacles": [)",
            R"("obstacles": [{"box": {"min": [101, 1, 0], "max": [102, 2, 0.3]}, "colour": "#0a0b0c"},
      {"cylinder": {"from": [103, 3, 0], "to": [103, 3, 1], "radius": 0.2}, "material": "steel"}, )");
    return text;
}

std::unique_ptr<sim::Simulation> simulate(const std::string& json, compute::Device& device) {
    auto message = scene::parseJson(json, "test");
    if (!message) throw std::runtime_error(message.error().text());
    auto scene = scene::build(*message, {});
    if (!scene) throw std::runtime_error(scene.error().text());
    auto simulation = sim::Simulation::create(device, std::move(*scene));
    if (!simulation) throw std::runtime_error(simulation.error().text());
    return std::move(*simulation);
}

struct Answer {
    std::shared_ptr<net::Document> document;
    int refusal = 0;  // HTTP status
};

std::future<Answer> ask(SceneSaver& saver) {
    auto promise = std::make_shared<std::promise<Answer>>();
    saver.ask([promise](std::shared_ptr<net::Document> document, const net::HttpAnswer& refusal) {
        promise->set_value({std::move(document), document ? 0 : refusal.status});
    });
    return promise->get_future();
}

std::string textOf(net::Document& document) {
    std::string text;
    for (std::string part = document.next(); !part.empty(); part = document.next()) text += part;
    return text;
}

std::string saved(sim::Simulation& simulation) {
    SceneSaver saver;
    saver.open();
    auto answer = ask(saver);
    saver.serve(simulation);
    return textOf(*answer.get().document);
}

class SaveScene : public testing::Test {
  protected:
    void checkRoundTrip(const std::string& json);

    std::unique_ptr<compute::Device> device_ = std::move(*compute::openDevice("cpu:1"));
};

void SaveScene::checkRoundTrip(const std::string& json) {
    const auto simulation = simulate(json, *device_);
    for (int k = 0; k < 60; ++k) ASSERT_TRUE(simulation->step());
    ASSERT_TRUE(simulation->apply(sim::Set{.gravity = glm::dvec3(0, 0, -5)}));
    ASSERT_TRUE(simulation->apply(sim::Remove{.spheres = {3, 7}}));
    for (int k = 0; k < 5; ++k) ASSERT_TRUE(simulation->step());
    const std::string text = saved(*simulation);
    const auto again = simulate(text, *device_);
    const scene::Scene& before = simulation->scene();
    const scene::Scene& after = again->scene();
    EXPECT_EQ(after.name, before.name);
    EXPECT_EQ(after.forces.gravity, before.forces.gravity);
    EXPECT_EQ(after.quality.substeps, before.quality.substeps);
    EXPECT_EQ(after.quality.goal, before.quality.goal);
    EXPECT_EQ(after.groups.size(), before.groups.size());
    EXPECT_EQ(after.sinks.size(), before.sinks.size());
    ASSERT_EQ(after.obstacles.size(), before.obstacles.size());
    for (std::size_t k = 0; k < after.obstacles.size(); ++k) {
        EXPECT_EQ(after.obstacles[k].shape->kind(), before.obstacles[k].shape->kind());
        EXPECT_EQ(after.obstacles[k].shape->distance({102.5, 2, 2}),
                  before.obstacles[k].shape->distance({102.5, 2, 2}));
        EXPECT_EQ(after.obstacles[k].colour, before.obstacles[k].colour);
        EXPECT_EQ(after.obstacles[k].material, before.obstacles[k].material);
    }
    EXPECT_EQ(after.forces.fields.size(), before.forces.fields.size());
    for (double x = 100.5; x < 104; x += 0.5) {
        const scene::Body body{.radius = 0.1, .mass = 3};
        const glm::dvec3 place(x, x - 100, 0.9);
        EXPECT_EQ(after.forces.accelerationAt(place, body), before.forces.accelerationAt(place, body));
        EXPECT_EQ(after.forces.dragAt(place, {1, 2, 3}, body), before.forces.dragAt(place, {1, 2, 3}, body));
    }
    EXPECT_EQ(after.sleep.time, before.sleep.time);
    EXPECT_EQ(after.materials[1].rollingResistance, before.materials[1].rollingResistance);
    EXPECT_EQ(after.pairs[0].restitution, before.pairs[0].restitution);
    EXPECT_EQ(after.bounds.periodic, before.bounds.periodic);
    EXPECT_EQ(after.groups[1].look.metal, 1);
    const sim::State a = simulation->snapshot();
    const sim::State b = again->snapshot();
    ASSERT_EQ(a.count(), b.count());
    for (std::uint32_t k = 0; k < a.count(); ++k) {
        EXPECT_LT(glm::length(sim::positionOf(a, k) - sim::positionOf(b, k)), 1e-6);
        EXPECT_EQ(sim::velocityOf(a, k), sim::velocityOf(b, k));
        EXPECT_EQ(sim::spinOf(a, k), sim::spinOf(b, k));
        EXPECT_EQ(a.position[k].w, b.position[k].w);
        EXPECT_EQ(after.spheres[k].material, before.spheres[k].material);
        EXPECT_EQ(after.spheres[k].fixed, before.spheres[k].fixed);
    }
    EXPECT_TRUE(saved(*again) == text) << "saving what was loaded gives the same file";
    ASSERT_TRUE(again->step());
}

TEST_F(SaveScene, GivesTheSameStateAndSettingsAgain) {
    checkRoundTrip(full);
}

TEST_F(SaveScene, GivesTheSameObstaclesAgain) {
    checkRoundTrip(withoutPeriodicAxis());
}

TEST_F(SaveScene, HasGroupsWithoutSpheres) {
    const auto simulation = simulate(full, *device_);
    ASSERT_TRUE(simulation->apply(sim::Remove{.spheres = {300, 301}}));
    const auto again = simulate(saved(*simulation), *device_);
    EXPECT_EQ(again->count(), 300U);
    EXPECT_EQ(again->scene().groups[1].name, "posts");
}

TEST_F(SaveScene, IsDoneOnceAtATime) {
    const auto simulation = simulate(full, *device_);
    SceneSaver saver;
    EXPECT_EQ(ask(saver).get().refusal, 404) << "there is no simulation yet";
    saver.open();
    auto first = ask(saver);
    EXPECT_EQ(ask(saver).get().refusal, 503);
    saver.serve(*simulation);
    auto document = first.get().document;
    ASSERT_TRUE(document);
    std::this_thread::sleep_for(1100ms);
    EXPECT_EQ(ask(saver).get().refusal, 503) << "the first one is still being sent";
    document.reset();
    auto next = ask(saver);
    saver.close();
    EXPECT_EQ(next.get().refusal, 503);
    EXPECT_EQ(ask(saver).get().refusal, 404);
}

TEST_F(SaveScene, CanBeAskedAgainAfterASimulationHasEndedBeforeItAnswered) {
    const auto simulation = simulate(full, *device_);
    SceneSaver saver;
    saver.open();
    auto first = ask(saver);
    saver.close();
    EXPECT_EQ(first.get().refusal, 503);
    std::this_thread::sleep_for(1100ms);
    saver.open();
    auto next = ask(saver);
    saver.serve(*simulation);
    EXPECT_TRUE(next.get().document);
}

}  // namespace
}  // namespace spherule::host
