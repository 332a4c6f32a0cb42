#pragma once

#include <filesystem>
#include <optional>

#include "core/result.h"
#include "scene/load.h"

namespace spherule::scene {

// Like build() of load.h, but the scene may name files relative to `directory`. nullopt: it may not name files.
Result<Scene> buildIn(const std::optional<std::filesystem::path>& directory, const v1::Scene& message,
                      const Overrides& overrides, Progress* progress = nullptr);

}  // namespace spherule::scene
