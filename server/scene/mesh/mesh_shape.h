#pragma once

#include <memory>

#include "scene/mesh/mesh.h"
#include "scene/shapes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

// An obstacle of triangles. `message` gives it in scenes: its mesh or its height field.
ShapePointer meshShape(std::shared_ptr<const Mesh> mesh, v1::Obstacle message);

// The same without a message, which a scene cannot be written with. Null if the triangles are refused.
ShapePointer meshShape(Triangles triangles, Mesh::Form form);

}  // namespace spherule::scene
