#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace spherule::physics {

// A change that takes a part of a scene away, with its name.
struct Removal {
    std::string part;
    std::function<void(scene::Scene&)> change;
};

// Returns the removals of all parts that the scene has. A face becomes a wall only in a scene that has walls: the first
// wall has costs of its own.
std::vector<Removal> removalsFrom(const scene::Scene& scene);

}  // namespace spherule::physics
