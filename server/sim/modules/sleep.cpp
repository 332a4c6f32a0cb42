#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "sim/modules/module.h"

namespace spherule::sim {

namespace {

void declareSleep(PlanBuilder& plan) {
    using enum Array;
    plan.arrays({RestReference, RestlessBlock, ActiveBlock, ActiveGroup, WakerGroup, VelocityBefore});
    plan.overPairsIf(Stage::Leavers, Pass::Grid, "wake.comp", LAUNCH_COLOUR, LEAVERS);
    plan.overSpheres(Stage::Activity, Pass::Sleep, "mark_active.comp");
    plan.overBundles(Stage::Activity, Pass::Sleep, "dilate_active.comp");
    plan.overPairs(Stage::Activity, Pass::Sleep, "wake.comp");
    plan.overSpheres(Stage::Sleep, Pass::Sleep, "sleep.comp");
}

void uploadSleep(const ParameterSource& from, layout::Parameters& p) {
    const scene::Scene& scene = from.scene;
    const double g = glm::length(scene.forces.gravity);
    // With friction, `balanced` leaves a support under load slower than gravity makes it in a substep. The sleep speed
    // is above that, and the wake speed well above the sleep speed, or a sphere would fall asleep and wake in turns. In
    // `fast`, a squeezed sphere is up to about 15 times as fast. Without friction, a bed takes long to come to rest.
    const double fall = g * from.substep;
    const Features& features = from.plan.features;
    const bool rests = features.has(Feature::Balanced) && features.has(Feature::Friction);
    const double sleepSpeed = rests ? std::max(scene.sleep.speed, fall) : scene.sleep.speed;
    p.sleepSpeed = static_cast<float>(sleepSpeed);
    p.wakeSpeed = static_cast<float>(std::max(3 * sleepSpeed, (rests ? 3 : 20) * fall));
    p.quietSpeed = rests ? p.sleepSpeed : p.wakeSpeed;
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
