#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include <google/protobuf/util/json_util.h>

#include "scene/part_changes.h"
#include "spherule/v1/scene_parts.pb.h"
#include "support.h"

// Changes of fields, emitters, materials and groups, for tests.
namespace spherule::physics {

using scene::Model;

// `json`: of the message of the command.
template <class Message>
sim::ChangePart change(const std::string& json) {
    Message message;
    const auto status = google::protobuf::util::JsonStringToMessage(json, &message);
    if (!status.ok()) throw std::invalid_argument(status.ToString());
    return {.make = [message](scene::Scene& scene) { return scene::changePart(scene, message); }};
}

sim::ChangePart addField(const std::string& field);
sim::ChangePart removeField(unsigned number);

// Builds a scene. Throws std::invalid_argument if it is refused.
scene::Scene sceneOf(const std::string& json);

// 80 spheres in two groups fall into a box. `more`: further members. `materials`: the entries.
scene::Scene fallingBox(Model model, const std::string& more = "",
                        const std::string& materials = R"({"friction": 0.3})");

extern const std::vector<std::string> fields;  // one of each kind, as JSON

extern const char* const jet;  // an emitter, as JSON

// A box without spheres. `emitters`: the entries.
scene::Scene emptyBox(const std::string& emitters, Model model);

std::uint64_t hashAfter(sim::Simulation& simulation, double seconds);
// The scene as it is saved, without its spheres.
std::string described(const sim::Simulation& simulation);
// Fails the test if the command is refused.
void apply(sim::Simulation& simulation, const sim::Command& command);
// Returns the text of the refusal, or "applied".
std::string refusalOf(sim::Simulation& simulation, const sim::Command& command);

}  // namespace spherule::physics
