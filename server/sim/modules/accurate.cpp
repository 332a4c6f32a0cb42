#include "sim/modules/module.h"

namespace spherule::sim {

namespace {

void declareForces(PlanBuilder& plan) {
    const bool contacts = plan.has(Feature::Contacts);
    if (!contacts && !plan.hasSurfaces()) return;
    plan.arrays({Array::DeltaVelocity});
    if (plan.has(Feature::Friction)) {
        plan.arrays({Array::DeltaOmega});
        if (plan.hasSurfaces()) plan.arrays({Array::WallSlip});
    }
    plan.overPairs(Stage::Solve, Pass::Forces, "solve_forces.comp");
    if (plan.hasSurfaces()) plan.overSpheres(Stage::Solve, Pass::WallForces, "walls_forces.comp");
    plan.overSpheres(Stage::Solve, Pass::Forces, "apply_forces.comp");
    if (contacts) plan.statisticsOfBundles("statistics_springs.comp");
}

}  // namespace

// The model `accurate`: soft spheres. All forces are added up before they are applied.
const Module moduleAccurate{
    .feature = Feature::Accurate,
    .required = [](const scene::Scene& scene,
                   const Features& /*others*/) { return scene.quality.model == scene::Model::Accurate; },
    .declare = declareForces,
    .cost = {.reason = "the table has columns for the models"},
};

// The part of a position that float32 cannot hold. The substeps of `accurate` are so short that without it a slow
// sphere would not move.
const Module moduleLowBits{
    .feature = Feature::LowBits,
    .required = [](const scene::Scene& /*scene*/, const Features& others) { return others.has(Feature::Accurate); },
    .declare = [](PlanBuilder& plan) { plan.arrays({Array::PositionLow}); },
    .cost = {.reason = "part of `accurate`"},
};

}  // namespace spherule::sim
