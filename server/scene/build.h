#pragma once

#include <filesystem>
#include <optional>

#include "core/result.h"
#include "scene/load.h"

namespace spherule::scene {

// build() of load.h for a scene that may name files, relative to `directory`; none: it may not.
Result<Scene> buildIn(const std::optional<std::filesystem::path>& directory, const v1::Scene& message,
                      const Overrides& overrides, Progress* progress = nullptr);

}  // namespace spherule::scene
