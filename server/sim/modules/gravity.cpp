#include <glm/geometric.hpp>

#include "sim/modules/module.h"

namespace spherule::sim {

// A uniform acceleration.
const Module moduleGravity{
    .feature = Feature::Gravity,
    .required = [](const scene::Scene& scene,
                   const Features& /*others*/) { return glm::length(scene.forces.gravity) > 0; },
    .upload =
        [](const ParameterSource& from, layout::Parameters& p) {
            p.gravity = glm::vec4(glm::vec3(from.scene.forces.gravity), 0);
            p.gravityChange = static_cast<float>(glm::length(from.scene.forces.gravity) * from.substep);
            p.deadBand = static_cast<float>(2 * glm::length(from.scene.forces.gravity) * from.substep);
        },
    .cost = {.reason = "without gravity, the bed does not rest"},
};

}  // namespace spherule::sim
