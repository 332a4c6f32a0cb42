#pragma once

#include "scene/check.h"
#include "scene/forces.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

// Reads gravity and the fields of a scene.
Forces readForces(Check& check, const v1::Scene& message);

// Sets gravity and the fields of a message.
void writeForces(v1::Scene& message, const Forces& forces);

}  // namespace spherule::scene
