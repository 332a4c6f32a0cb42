#pragma once

#include <string>
#include <string_view>

#include "scene/load.h"
#include "temporary_folder.h"

namespace spherule::scene::testing {

// Builds a scene in the unit cube. `members`: its other members as JSON, such as `"step": 0.01, "groups": []`.
Result<Scene> builtWith(std::string_view members, const Overrides& overrides = {});

// Returns the scene. If it is refused, the test fails and the scene is empty.
Scene sceneWith(std::string_view members, const Overrides& overrides = {});

// Returns the text of the refusal, or "accepted".
std::string refusalOf(std::string_view members, const Overrides& overrides = {});

// Returns a JSON object with these members.
std::string object(std::string_view members);

// Returns the member `groups`, with one group that has these members.
std::string group(std::string_view members);

v1::Scene parsed(const std::string& json);

using support::TemporaryFolder;

}  // namespace spherule::scene::testing
