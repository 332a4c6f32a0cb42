#pragma once

#include <string>
#include <string_view>

#include "core/result.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

// Converts JSON text to a message. Errors in JSON are "file:line:column" if the place is known. Errors of unknown
// fields and of wrong types are "file: field.path". `file` only names the text in errors.
Result<v1::Scene> parseJson(const std::string& text, std::string_view file);

}  // namespace spherule::scene
