#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "scene/load.h"

namespace spherule::scene {

// Like build() of load.h, but the scene may name files relative to `directory`. nullopt: it may not name files.
Result<Scene> buildIn(const std::optional<std::filesystem::path>& directory, const v1::Scene& message,
                      const Overrides& overrides, Progress* progress = nullptr);

// Returns the errors of the scene, each with the path of a field: the first one of each part that is read by itself, at
// most mostMistakes. `doubts`: paths of values that are known to be wrong, and that the message lacks. Errors that
// follow from them are left out.
std::vector<Error> errorsIn(const std::optional<std::filesystem::path>& directory, const v1::Scene& message,
                            std::vector<std::string> doubts);

}  // namespace spherule::scene
