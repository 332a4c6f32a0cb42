#include <algorithm>

#include "sim/modules/module.h"

namespace spherule::sim {

// Some spheres are fixed: their inverse mass is 0, and nothing moves them.
const Module moduleFixed{
    .feature = Feature::Fixed,
    .required = [](const scene::Scene& scene,
                   const Features& /*others*/) { return std::ranges::any_of(scene.spheres, &scene::Sphere::fixed); },
    .cost = {.name = "one sphere fixed", .with = [](scene::Scene& scene) { scene.spheres.front().fixed = true; }},
};

}  // namespace spherule::sim
