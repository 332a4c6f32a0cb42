#pragma once

#include <string>

namespace spherule::scene {

// Returns the JSON Schema (draft 2020-12) of scene files. It follows from scene.proto: names as in JSON, types, ranges,
// required fields and descriptions. Any thread.
std::string jsonSchema();

}  // namespace spherule::scene
