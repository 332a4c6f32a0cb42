#pragma once

#include <string>
#include <string_view>

#include "scene/load.h"
#include "temporary_folder.h"

namespace spherule::scene::testing {

// A scene in the unit cube with these further members, as JSON: `"step": 0.01, "groups": []`.
Result<Scene> builtWith(std::string_view members, const Overrides& overrides = {});

// The scene, or a failed test and an empty one.
Scene sceneWith(std::string_view members, const Overrides& overrides = {});

// The text of the refusal, or "accepted".
std::string refusalOf(std::string_view members, const Overrides& overrides = {});

// Members in braces.
std::string object(std::string_view members);

// One group with these members.
std::string group(std::string_view members);

v1::Scene parsed(const std::string& json);

using support::TemporaryFolder;

}  // namespace spherule::scene::testing
