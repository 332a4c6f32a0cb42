#pragma once

#include <cstddef>
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

// Chooses the substeps, unless they are pinned. Returns an error if the model cannot work with them.
Result<void> fitSubsteps(Scene& scene);

// The substeps that the model would choose itself for the scene, or why it cannot have it.
Result<std::uint32_t> substepsFor(const Scene& scene, Model model);

// That the model can do with at all.
std::uint32_t fewestSubsteps(const Scene& scene, Model model);

// The most that a step of the scene can have, with its model: more would keep everything else waiting for too long.
std::uint32_t mostSubsteps(const Scene& scene);

// The most that it is given while something is very fast.
std::uint32_t mostRaised(const Scene& scene);

// In a substep a sphere should move less than this share of its radius, or it may pass through what it should hit.
constexpr double farMotion = 0.5;

// The fastest that a sphere of this radius (m) can be in the scene (m/s), with more substeps while it is so fast.
double mostSpeed(const Scene& scene, double radius);

// Refuses spheres, from id `first` on, that begin faster than that.
Result<void> checkSpeeds(const Scene& scene, std::size_t first = 0);

// Within which the model is of use for the scene, as far as was measured.
struct SubstepRange {
    std::uint32_t fewest = 1;
    std::uint32_t most = 1;
};
SubstepRange substepRange(const Scene& scene, Model model);

// Sets the scene's quality, which depends on all the rest of it.
void readQuality(Check& check, const v1::Quality& message, const Overrides& overrides, Scene& scene);

}  // namespace spherule::scene
