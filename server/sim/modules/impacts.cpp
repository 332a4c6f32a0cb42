#include "sim/modules/module.h"

namespace spherule::sim {

// Measures restitution in observed steps: the speeds at which colliding pairs approach and part. The models `fast` and
// `balanced` resolve an impact within one substep.
const Module moduleImpacts{
    .feature = Feature::Impacts,
    .required = [](const scene::Scene& /*scene*/,
                   const Features& others) { return others.has(Feature::Contacts) && !others.has(Feature::Accurate); },
    .declare =
        [](PlanBuilder& plan) {
            // Nothing else uses the scratch column between two rebuilds.
            const std::vector<Alias> aliases{{"velocityBeforeSolve", Array::SortScratch}};
            plan.arrays({Array::Impacts});
            plan.observeSpheres(Stage::BeforeSolve, "velocity_before_solve.comp", aliases);
            plan.observeBundles(Stage::AfterSolve, "statistics_impacts.comp", aliases);
        },
    .cost = {.name = "impacts observed"},
};

}  // namespace spherule::sim
