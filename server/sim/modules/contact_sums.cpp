#include "sim/modules/module.h"

namespace spherule::sim {

// Sums over the contacts of every substep: the virial, the work of contacts, collisions, and the loads of surfaces.
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
            if (!plan.hasSurfaces()) return;
            plan.arrays({Array::SurfaceSums});
            if (plan.has(Feature::Balanced) && plan.has(Feature::Sleep))
                plan.overSpheres(Stage::AfterSolve, Pass::Statistics, "surface_sums.comp");
        },
    .cost = {.name = "contact sums", .with = [](scene::Scene& scene) { scene.contactSums = true; }},
};

}  // namespace spherule::sim
