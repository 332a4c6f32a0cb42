#include "sim/modules/module.h"

namespace spherule::sim {

namespace {

void declareSolver(PlanBuilder& plan) {
    using enum Array;
    const bool contacts = plan.has(Feature::Contacts);
    const bool friction = plan.has(Feature::Friction);
    plan.arrays({VelocityBefore, UnheldVelocity, AccelerationXz, AccelerationYz});
    if (friction) plan.arrays({UnheldSpin});
    if (plan.hasSurfaces()) plan.arrays({WallImpulse});
    if (plan.hasSurfaces() && friction) plan.arrays({WallTorque});
    plan.overSpheres(Stage::Begin, Pass::Begin, "begin_substep.comp");
    plan.overSpheres(Stage::Finish, Pass::Finish, "finish_substep.comp");
    if (!contacts) return;
    plan.overPairs(Stage::Solve, Pass::Contacts, "solve_contacts.comp");
    plan.overPairsIf(Stage::Solve, Pass::Contacts, "solve_unlisted.comp", LAUNCH_UNLISTED);
}

void declareScaling(PlanBuilder& plan) {
    if (plan.has(Feature::Contacts)) plan.onNewSubstepOverPairs("scale_pairs.comp");
    plan.onNewSubstepOverSpheres("scale_spheres.comp");
}

}  // namespace

// The model `balanced`: one visit of each pair in a substep, which begins with the impulse that the contact held
// before.
const Module moduleBalanced{
    .feature = Feature::Balanced,
    .required = [](const scene::Scene& scene,
                   const Features& /*others*/) { return scene.quality.model == scene::Model::Balanced; },
    .declare =
        [](PlanBuilder& plan) {
            declareSolver(plan);
            declareScaling(plan);
        },
    .cost = {.reason = "the table has columns for the models"},
};

}  // namespace spherule::sim
