#pragma once

#include "scene/scene.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

// Returns the scene as a message, with its present settings, from which build() makes the same scene. Its groups have
// no spheres. `time`: s simulated; obstacles go on moving from there.
v1::Scene describe(const Scene& scene, double time);

}  // namespace spherule::scene
