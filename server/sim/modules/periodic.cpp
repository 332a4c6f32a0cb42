#include "sim/modules/module.h"

namespace spherule::sim {

namespace {

void declareWrap(PlanBuilder& plan) {
    plan.arrays({Array::Images});
    if (plan.has(Feature::Contacts))
        plan.onRebuild(Stage::Carry, Pass::Grid, "wrap_positions.comp", LAUNCH_COLUMNS);
    else
        plan.overSpheres(Stage::Integrate, Pass::Integrate, "wrap_positions.comp");
}

void uploadPeriods(const ParameterSource& from, layout::Parameters& p) {
    const glm::dvec3 periods = from.scene.bounds.periods();
    for (int axis = 0; axis < 3; ++axis) {
        if (!(periods[axis] > 0)) continue;
        p.halfLength[axis] = static_cast<float>(0.5 * periods[axis]);
        p.perLength[axis] = static_cast<float>(1 / periods[axis]);
        p.wallMin[axis] = -p.halfLength[axis];
        p.wallMax[axis] = p.halfLength[axis];
    }
}

}  // namespace

// An axis of the bounds is periodic.
const Module modulePeriodic{
    .feature = Feature::Periodic,
    .required = [](const scene::Scene& scene, const Features& /*others*/) { return scene.bounds.anyPeriodic(); },
    .declare = declareWrap,
    .upload = uploadPeriods,
    .cost = {.name = "periodic sides",
             .with =
                 [](scene::Scene& scene) {
                     scene.bounds.periodic = {true, true, false};
                 }},
};

}  // namespace spherule::sim
