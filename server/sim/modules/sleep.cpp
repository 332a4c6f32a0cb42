#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "sim/modules/module.h"

namespace spherule::sim {

namespace {

void declareSleep(PlanBuilder& plan) {
    using enum Array;
    plan.arrays({RestReference, WakeFlags, ActiveGroup});
    plan.onRebuild(Stage::Wake, Pass::Grid, "wake.comp", LAUNCH_GROUPS);
    plan.onRebuild(Stage::Wake, Pass::Grid, "wake_flagged.comp", LAUNCH_SPHERES);
    plan.overSpheres(Stage::Activity, Pass::Sleep, "mark_active.comp");
    plan.overGroups(Stage::Activity, Pass::Sleep, "dilate_active.comp");
    plan.overSpheres(Stage::Sleep, Pass::Sleep, "sleep.comp");
}

void uploadSleep(const ParameterSource& from, layout::Parameters& p) {
    const scene::Scene& scene = from.scene;
    const double g = glm::length(scene.forces.gravity);
    // The wake speed is well above the sleep speed, or a sphere would fall asleep and wake in turns. It is also above
    // the speed that the solver's pushes give a squeezed sphere: up to about 15 g h in a bed 20 spheres deep (h:
    // substep). `moveAwayDistance` detects a sphere that moves away more slowly.
    constexpr double pushes = 20;
    p.sleepSpeed = static_cast<float>(scene.sleep.speed);
    p.wakeSpeed = static_cast<float>(std::max(3 * scene.sleep.speed, pushes * g * from.substep));
    // A sphere that stays within this distance of one place for the sleep time has not crossed it faster than the sleep
    // speed.
    const double moveAwayDistance =
        std::min(static_cast<double>(from.plan.grid.margin) / 3, 0.5 * scene.sleep.speed * scene.sleep.time);
    p.moveAwayDistance = static_cast<float>(moveAwayDistance);
    // In weak gravity, a free flight stays within that distance of its top for up to 3.4 sqrt(moveAwayDistance / g).
    p.sleepTime = static_cast<float>(std::max(scene.sleep.time, g > 0 ? 4 * std::sqrt(moveAwayDistance / g) : 0.0));
}

}  // namespace

// Spheres at rest fall asleep: the solver skips them until something wakes them.
const Module moduleSleep{
    .feature = Feature::Sleep,
    // Without gravity nothing rests: a slow sphere only drifts. Without contacts sleep saves nothing. In `accurate` no
    // sphere sleeps, because the model is meant to show the forces in a pile.
    .required =
        [](const scene::Scene& scene, const Features& others) {
            return scene.sleep.enabled && others.has(Feature::Contacts) && others.has(Feature::Gravity) &&
                   !others.has(Feature::Accurate);
        },
    .declare = declareSleep,
    .upload = uploadSleep,
    .cost = {.name = "sleep, nobody asleep",
             .with =
                 [](scene::Scene& scene) {
                     scene.sleep.enabled = true;
                     scene.sleep.time = 1e6;
                 }},
};

}  // namespace spherule::sim
