#include "sim/modules/module.h"

namespace spherule::sim {

// The model `fast`: impulses with restitution at the moment of impact, other overlaps corrected by position.
const Module moduleFast{
    .feature = Feature::Fast,
    .required = [](const scene::Scene& scene,
                   const Features& /*others*/) { return scene.quality.model == scene::Model::Fast; },
    .declare =
        [](PlanBuilder& plan) {
            plan.overPairs(Stage::Solve, Pass::Impulses, "solve_impulses.comp");
            if (!plan.hasSurfaces()) return;
            if (plan.has(Feature::Gravity) || plan.has(Feature::Fields)) plan.arrays({Array::WallWork});
            plan.overSpheres(Stage::Solve, Pass::WallImpulses, "walls_impulses.comp");
        },
    .cost = {.reason = "the table has columns for the models"},
};

}  // namespace spherule::sim
