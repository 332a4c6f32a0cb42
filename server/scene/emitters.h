#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "scene/check.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

constexpr std::size_t maxEmitters = 16;
constexpr double mostBirthsPerStep = 4096;  // of all emitters of a scene

// Reads the emitters of a scene whose bounds, materials, obstacles and groups are read, and adds a group for each.
// `seed` replaces their seeds.
void readEmitters(Check& check, const v1::Scene& message, std::optional<std::uint64_t> seed, Scene& scene);

// The context in which an emitter is read.
struct EmitterContext {
    std::string field;         // "emitters[2]"
    std::uint64_t stream = 0;  // see Emitter
    std::uint16_t group = 0;
    double origin = 0;  // s simulated: its `begin` counts from here
};

// Reads an emitter. It has free places at the scene's time.
Emitter readEmitter(Check& check, const v1::Emitter& message, const EmitterContext& context, const Scene& scene);

// Gives the emitter the density of its material, and refuses a stream that is too dense then.
void useMaterial(Check& check, Emitter& emitter, const Scene& scene, const std::string& field);

// Returns the group of the emitter's spheres.
Group groupFor(Check& check, const v1::Emitter& message, const Emitter& emitter, const std::string& field);

// Refuses emitters that make too many spheres in a step together. `field`: of the last one.
void checkBirths(Check& check, const Scene& scene, const std::string& field);

// Refuses emitters whose spheres are faster than the scene can compute. Call it when the substeps are known.
void checkEmitterSpeeds(Check& check, const Scene& scene);

// Writes the emitters of a scene whose time begins now. `time`: s simulated. `progress`: of each. Leaves out those that
// have ended.
void writeEmitters(v1::Scene& message, const Scene& scene, double time, std::span<const EmitterProgress> progress);

}  // namespace spherule::scene
