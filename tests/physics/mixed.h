#pragma once

#include <cstdint>

#include "support.h"

namespace spherule::physics {

// Adds spheres of radii from `largest` / `ratio` to `largest` to the scene, without overlaps. Few are large. There is
// at least one sphere of each extreme radius.
void scatterMixed(scene::Scene& scene, std::uint32_t count, double largest, double ratio, std::uint64_t seed = 1);

// A bed of `count` spheres of 5 to 20 mm below a sphere that is `ratio` times as large as the smallest. With a ratio of
// 1, all spheres have 12 mm, and there is no sphere above.
scene::Scene bedUnderOne(std::uint32_t count, double ratio);

}  // namespace spherule::physics
