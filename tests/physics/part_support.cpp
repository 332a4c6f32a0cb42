#include "part_support.h"

#include <fmt/format.h>

#include "scene/describe.h"
#include "scene_support.h"

namespace spherule::physics {

namespace {

std::string modelNameOf(Model model) {
    return model == Model::Fast ? "FAST" : model == Model::Balanced ? "BALANCED" : "ACCURATE";
}

}  // namespace

const std::vector<std::string> fields = {
    R"({"drag": {"density": 5}})",
    R"({"drag": {"density": 5, "velocity": [8, 0, 2]}, "inBox": {"min": [-1, -1, 0], "max": [0, 1, 1]}})",
    R"({"attraction": {"centre": [0.2, 0, 0.5], "strength": 2, "softening": 0.3}})",
    R"({"buoyancy": {"density": 700, "surface": [0, 0, 0.5]}})",
    R"({"spring": {"centre": [0, 0, 0.5], "stiffness": 8, "damping": 0.5}, "inSphere": {"centre": [0, 0, 0.5],
        "radius": 0.3}})"};

const char* const jet = R"({"name": "jet", "disc": {"centre": [0, 0, 0.8], "normal": [0, 0, 1], "radius": 0.3},
    "rate": 90, "radius": {"uniform": {"min": 0.02, "max": 0.03}}, "velocity": [0.5, 0, -1], "velocitySpread": 0.3})";

scene::Scene emptyBox(const std::string& emitters, Model model) {
    return sceneOf(
        fmt::format(R"({{"bounds": {{"min": [-0.5, -0.5, 0], "max": [0.5, 0.5, 1]}}, "quality": {{"model": "{}"}},
                           "materials": [{{"friction": 0.3}}], "emitters": [{}]}})",
                    modelNameOf(model), emitters));
}

sim::ChangePart addField(const std::string& field) {
    return change<v1::AddField>(fmt::format(R"({{"field": {}}})", field));
}

sim::ChangePart removeField(unsigned number) {
    return change<v1::RemoveField>(fmt::format(R"({{"number": {}}})", number));
}

scene::Scene sceneOf(const std::string& json) {
    auto built = scene::build(scene::testing::parsed(json));
    if (!built) throw std::invalid_argument(built.error().text());
    return std::move(*built);
}

scene::Scene fallingBox(Model model, const std::string& more, const std::string& materials) {
    return sceneOf(fmt::format(
        R"({{"bounds": {{"min": [-0.5, -0.5, 0], "max": [0.5, 0.5, 1]}}, "quality": {{"model": "{}"}},
        "materials": [{}],
        "groups": [{{"fill": {{"min": [-0.5, -0.5, 0], "max": [0.5, 0.5, 0.6], "count": 60}},
                    "radius": {{"uniform": {{"min": 0.04, "max": 0.05}}}}}},
                   {{"fill": {{"min": [-0.5, -0.5, 0.6], "max": [0.5, 0.5, 1], "count": 20}},
                    "radius": {{"constant": 0.045}}}}] {}}})",
        modelNameOf(model), materials, more));
}

std::uint64_t hashAfter(sim::Simulation& simulation, double seconds) {
    run(simulation, seconds);
    return sim::hashOf(simulation.snapshot());
}

std::string described(const sim::Simulation& simulation) {
    return scene::describe(simulation.scene(), 0, simulation.flows().emission.progress(simulation.scene()))
        .SerializeAsString();
}

void apply(sim::Simulation& simulation, const sim::Command& command) {
    const auto applied = simulation.apply(command);
    ASSERT_TRUE(applied) << applied.error().text();
}

std::string refusalOf(sim::Simulation& simulation, const sim::Command& command) {
    const auto applied = simulation.apply(command);
    return applied ? "applied" : applied.error().text();
}

}  // namespace spherule::physics
