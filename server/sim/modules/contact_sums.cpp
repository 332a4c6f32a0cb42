#include "sim/modules/module.h"

namespace spherule::sim {

// Sums over the contacts of every substep: the virial, the work of contacts, and collisions.
const Module moduleContactSums{
    .feature = Feature::ContactSums,
    .required = [](const scene::Scene& scene, const Features& /*others*/) { return scene.contactSums; },
    .declare =
        [](PlanBuilder& plan) {
            plan.arrays({Array::StartVelocity, Array::WorkOfContacts});
            if (plan.has(Feature::Friction)) plan.arrays({Array::StartSpin});
            if (plan.has(Feature::Fast) || plan.has(Feature::Fields)) plan.arrays({Array::StartPosition});
            plan.overSpheres(Stage::ContactSums, Pass::Statistics, "contact_sums_begin.comp");
            plan.overStatisticBlocks(Stage::AfterSolve, Pass::Statistics, "contact_sums_end.comp");
        },
    .cost = {.name = "contact sums", .with = [](scene::Scene& scene) { scene.contactSums = true; }},
};

}  // namespace spherule::sim
