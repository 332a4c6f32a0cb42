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
Model modelOf(v1::Model message);  // `message` must not be MODEL_UNSPECIFIED
v1::Model messageOf(Model model);

// Returns the smallest radius of the spheres that the scene has and may get from emitters (m); 0 without any.
double smallestRadiusIn(const Scene& scene);

// Returns an error if the materials lack a value that the model needs.
Result<void> checkModel(const Scene& scene);

// Chooses the substeps, unless they are fixed. Returns an error if the model cannot work with them.
Result<void> fitSubsteps(Scene& scene);

// Returns the substeps that the model would choose for the scene, or why the scene cannot use the model.
Result<std::uint32_t> substepsFor(const Scene& scene, Model model);

// Returns the fewest substeps with which the model works.
std::uint32_t minSubstepsFor(const Scene& scene, Model model);

// Returns the most substeps allowed for the scene with its model. With more, a step would delay everything else for too
// long.
std::uint32_t maxSubstepsFor(const Scene& scene);

// Returns the substeps that take about ten seconds per step on one processor.
double substepsOfTenSeconds(const Scene& scene);

// Returns the most substeps that the simulation uses while a sphere is very fast.
std::uint32_t maxRaisedSubsteps(const Scene& scene);

// In a substep a sphere should move less than this share of its radius. If it moves farther, it may pass through an
// object that it should hit.
constexpr double safeMotion = 0.5;

// Returns the largest speed (m/s) of a sphere of this radius (m) that the scene can compute, with maxRaisedSubsteps()
// substeps.
double maxSpeed(const Scene& scene, double radius);

// Refuses spheres from id `first` on whose initial speed exceeds maxSpeed().
Result<void> checkSpeeds(const Scene& scene, std::size_t first = 0);

// Refuses obstacles whose surface moves faster than maxSpeed() for the smallest sphere.
Result<void> checkObstacleSpeeds(const Scene& scene);

// The range of substeps in which the model is useful for the scene, by measurement.
struct SubstepRange {
    std::uint32_t fewest = 1;
    std::uint32_t most = 1;
};
SubstepRange substepRange(const Scene& scene, Model model);

// Sets the scene's quality. Call it last, because quality depends on all other parts of the scene.
void readQuality(Check& check, const v1::Quality& message, const Overrides& overrides, Scene& scene);

}  // namespace spherule::scene
