#include "scene/load.h"
#include "sim/modules/module.h"
#include "sim/parameters.h"

namespace spherule::sim {

// Regions in which spheres are removed at the end of each step.
const Module moduleSinks{
    .feature = Feature::Sinks,
    .required = [](const scene::Scene& scene, const Features& /*others*/) { return !scene.sinks.empty(); },
    .declare = [](PlanBuilder& plan) { plan.atStepEnd(Pass::Statistics, "sinks.comp"); },
    .upload =
        [](const ParameterSource& from, layout::Parameters& p) {
            static_assert(scene::maxSinks == MOST_SINKS);
            const std::vector<scene::Box> sinks = sinksOnDevice(from.scene);
            for (std::size_t k = 0; k < sinks.size(); ++k) {
                p.sinkMin[k] = glm::vec4(glm::vec3(sinks[k].min), 0);
                p.sinkMax[k] = glm::vec4(glm::vec3(sinks[k].max), 0);
            }
            p.sinkMin[0].w = static_cast<float>(sinks.size());
        },
    .cost = {.name = "a sink without spheres",
             .with =
                 [](scene::Scene& scene) {
                     const glm::dvec3 top = scene.bounds.max;
                     scene.sinks = {{top, top + (top - scene.bounds.min)}};
                 }},
};

}  // namespace spherule::sim
