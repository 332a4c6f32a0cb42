#pragma once

#include <optional>
#include <string_view>

#include "scene/check.h"
#include "scene/load.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

std::string_view nameOf(Model model);  // "fast", "balanced" or "accurate"
std::optional<Model> modelNamed(std::string_view name);
Model modelOf(v1::Model message);  // of one that is specified
v1::Model messageOf(Model model);

// Whether the materials have what the model needs.
Result<void> checkModel(const Scene& scene);

// Chooses the substeps anew, unless they are pinned; then says whether the model can do with them.
Result<void> fitSubsteps(Scene& scene);

// Sets the scene's quality, which depends on all the rest of it.
void readQuality(Check& check, const v1::Quality& message, const Overrides& overrides, Scene& scene);

}  // namespace spherule::scene
