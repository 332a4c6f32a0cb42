#pragma once

#include <cstdint>

#include "support.h"

namespace spherule::physics {

// Puts spheres of radii from `largest` / `ratio` to `largest` into the scene's bounds, where none overlaps another; few
// are large, and there is one of each end.
void scatterMixed(scene::Scene& scene, std::uint32_t count, double largest, double ratio, std::uint64_t seed = 1);

// A sphere of 0.5 m above a bed of `count` spheres `ratio` times smaller, or up to four times as large as those, in a
// box as wide as the large one; without it, the bed alone is as wide as its spheres ask for.
scene::Scene bedUnderOne(std::uint32_t count, double ratio);

}  // namespace spherule::physics
