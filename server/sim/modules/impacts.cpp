#include "sim/modules/module.h"

namespace spherule::sim {

// In observed steps: how fast the pairs that meet approach and part, for the restitution that is measured. `fast` and
// `balanced` carry an impact out within one substep.
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
            plan.observeGroups(Stage::AfterSolve, "statistics_impacts.comp", aliases);
        },
};

}  // namespace spherule::sim
