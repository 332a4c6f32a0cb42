#pragma once

#include <string>
#include <string_view>

#include "core/result.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

// JSON text to a message. Text that is not JSON is refused as "file:line:column" where the place can be told; unknown
// fields and values of a wrong type as "file: field.path". `file` only names the text in errors.
Result<v1::Scene> parseJson(const std::string& text, std::string_view file);

}  // namespace spherule::scene
