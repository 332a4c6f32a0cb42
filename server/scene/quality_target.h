#pragma once

#include <optional>
#include <string_view>

#include "core/result.h"
#include "scene/scene.h"
#include "spherule/v1/scene.pb.h"

// The target of `auto` quality.
namespace spherule::scene {

// Returns the target of a message; nullopt if it has none. Input if the target is invalid, with its field below
// `where`.
Result<std::optional<QualityTarget>> qualityTargetOf(const v1::Auto& message, std::string_view where);
v1::Auto messageOf(const QualityTarget& target);

}  // namespace spherule::scene
