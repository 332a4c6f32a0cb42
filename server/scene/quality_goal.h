#pragma once

#include <optional>
#include <string_view>

#include "core/result.h"
#include "scene/scene.h"
#include "spherule/v1/scene.pb.h"

// The goal of `auto` quality.
namespace spherule::scene {

// Returns the goal of a message; nullopt if it has none. Input if the goal is invalid, with its field below
// `where`.
Result<std::optional<QualityGoal>> qualityGoalOf(const v1::Auto& message, std::string_view where);
v1::Auto messageOf(const QualityGoal& goal);

}  // namespace spherule::scene
