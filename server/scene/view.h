#pragma once

#include "scene/check.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

// Returns a camera that sees all of the bounds, from the front, a little from the right and from above. It assumes a
// picture that is at least 3:2 wide.
Camera framing(const Bounds& bounds, double fieldOfView);

// Reads the camera. If eye and target are absent, it is framing().
Camera readCamera(Check& check, const v1::Camera& message, const Bounds& bounds);

Light readLight(Check& check, const v1::Light& message);
// Returns the light as scenes and facts have it.
v1::Light messageOf(const Light& light);

}  // namespace spherule::scene
