#pragma once

#include <string_view>

#include "core/result.h"
#include "scene/check.h"
#include "scene/scene.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

// Reads `periodic` of the bounds, whose corners and open faces have been read.
void readPeriodicAxes(Check& check, const v1::Bounds& message, std::string_view field, Bounds& bounds);

// Returns true if the region has the whole length of a periodic axis: what is placed in it may then reach across the
// seam.
bool spansPeriod(const Bounds& bounds, const Box& region, int axis);

// Returns the image of a place that is inside the bounds along the periodic axes.
glm::dvec3 insideBounds(const Bounds& bounds, glm::dvec3 place);

// Refuses what periodic axes exclude: obstacles that are not the same along the whole axis, and forces that are not.
Result<void> checkPeriodicAxes(const Scene& scene);

}  // namespace spherule::scene
