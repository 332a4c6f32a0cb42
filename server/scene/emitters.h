#pragma once

#include <optional>
#include <span>

#include "scene/check.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

constexpr std::size_t maxEmitters = 16;
constexpr double mostBirthsPerStep = 4096;  // of all emitters of a scene

// Reads the emitters of a scene whose bounds, materials, obstacles and groups are read, and adds a group for each.
// `seed` replaces their seeds.
void readEmitters(Check& check, const v1::Scene& message, std::optional<std::uint64_t> seed, Scene& scene);

// Refuses emitters whose spheres are faster than the scene can compute. Call it when the substeps are known.
void checkEmitterSpeeds(Check& check, const Scene& scene);

// Writes the emitters of a scene whose time begins now. `time`: s simulated. `born`: the spheres that each has made.
// Leaves out those that have made all their spheres.
void writeEmitters(v1::Scene& message, const Scene& scene, double time, std::span<const std::uint64_t> born);

}  // namespace spherule::scene
