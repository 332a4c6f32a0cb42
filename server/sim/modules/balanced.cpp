#include "sim/modules/module.h"

namespace spherule::sim {

// The model `balanced`: resolves overlaps by moving spheres, then sets the velocities after impacts. The friction
// module adds its own two passes.
const Module moduleBalanced{
    .feature = Feature::Balanced,
    .required = [](const scene::Scene& scene,
                   const Features& /*others*/) { return scene.quality.model == scene::Model::Balanced; },
    .declare =
        [](PlanBuilder& plan) {
            if (plan.has(Feature::Contacts)) plan.arrays({Array::Touching});
            plan.overPairs(Stage::Solve, Pass::Positions, "solve_positions.comp");
            if (plan.hasSurfaces()) plan.overSpheres(Stage::Solve, Pass::WallPositions, "walls_positions.comp");
            plan.overPairs(Stage::Solve, Pass::Velocities, "solve_velocities.comp");
            if (plan.hasSurfaces()) plan.overSpheres(Stage::Solve, Pass::WallVelocities, "walls_velocities.comp");
        },
    .cost = {.reason = "the table has columns for the models"},
};

// The velocity before the substep. Impacts and sleep are detected by it.
const Module moduleVelocityBefore{
    .feature = Feature::VelocityBefore,
    .required =
        [](const scene::Scene& /*scene*/, const Features& others) {
            const bool impacts = others.has(Feature::Contacts) || others.has(Feature::Restitution);
            return others.has(Feature::Sleep) || (others.has(Feature::Balanced) && impacts);
        },
    .declare = [](PlanBuilder& plan) { plan.arrays({Array::VelocityBefore}); },
    .cost = {.reason = "part of `balanced` and of sleep"},
};

}  // namespace spherule::sim
