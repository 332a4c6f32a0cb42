#pragma once

#include "scene/check.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

// The camera from which all of the bounds is seen, from the front, a little from the right and from above, in a picture
// at least 3:2 wide.
Camera framing(const Bounds& bounds, double fieldOfView);

// Absent eye and target: framing().
Camera readCamera(Check& check, const v1::Camera& message, const Bounds& bounds);

}  // namespace spherule::scene
