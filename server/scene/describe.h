#pragma once

#include <span>

#include "scene/scene.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

// Returns the scene as a message, with its present settings, from which build() makes the same scene. Its groups have
// no spheres. `time`: s simulated; obstacles and emitters go on from there. `emitters`: their progress.
v1::Scene describe(const Scene& scene, double time, std::span<const EmitterProgress> emitters = {});

// Writes the materials and the pairs of a scene.
void writeMaterials(const Scene& scene, google::protobuf::RepeatedPtrField<v1::Material>& materials,
                    google::protobuf::RepeatedPtrField<v1::MaterialPair>& pairs);

}  // namespace spherule::scene
