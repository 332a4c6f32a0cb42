#pragma once

#include <cstdint>

#include "support.h"

namespace spherule::physics {

// Puts spheres of radii from `largest` / `ratio` to `largest` into the scene's bounds, where none overlaps another; few
// are large, and there is one of each end.
void scatterMixed(scene::Scene& scene, std::uint32_t count, double largest, double ratio, std::uint64_t seed = 1);

// A bed of `count` spheres of 5 to 20 mm, and above it one that is `ratio` times as large as the smallest; none for a
// ratio of 1, where all have 12 mm.
scene::Scene bedUnderOne(std::uint32_t count, double ratio);

}  // namespace spherule::physics
