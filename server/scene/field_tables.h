#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result.h"

namespace spherule::scene {

// Returns the fields of these messages of scene.proto as one table in Markdown: unit, default, allowed values and
// meaning. A name may be "prefix=Message"; its fields are then named "prefix.field". Errors: no such message. Any
// thread.
Result<std::string> fieldTable(const std::vector<std::string>& messages);

// Returns the tables of all messages of a scene, each with its name and meaning. Any thread.
std::string fieldTables();

}  // namespace spherule::scene
