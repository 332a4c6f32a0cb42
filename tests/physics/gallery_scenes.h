#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/scene.h"

namespace spherule::physics {

// Returns the names of the scenes of the program, each scene once.
std::vector<std::string> galleryScenes();

// The name of a test whose parameter is the name of a scene.
std::string testNameOf(const testing::TestParamInfo<std::string>& parameter);

// Returns the scene with at most `most` spheres that are not fixed at the beginning. Each group keeps the same share of
// its spheres, those with the lowest ids. Fixed spheres, obstacles, emitters, sinks, fields and the substeps stay as
// they are.
scene::Scene reduced(scene::Scene scene, std::uint32_t most);

}  // namespace spherule::physics
