#include <algorithm>

#include "scene/materials.h"
#include "sim/modules/module.h"

namespace spherule::sim {

namespace {

bool anyContact(const scene::Scene& scene, bool (*holds)(const scene::PairLaw&)) {
    return std::ranges::any_of(scene::actingLaws(scene), holds);
}

}  // namespace

// Some contact in the scene has restitution.
const Module moduleRestitution{
    .feature = Feature::Restitution,
    .required =
        [](const scene::Scene& scene, const Features& /*others*/) {
            return anyContact(scene, [](const auto& law) { return law.restitution > 0; });
        },
};

// Spheres have more than one material: kernels look up the contact parameters by pair of materials.
const Module moduleMaterials{
    .feature = Feature::Materials,
    .required =
        [](const scene::Scene& scene, const Features& /*others*/) {
            return std::ranges::any_of(
                scene.spheres, [&](const scene::Sphere& s) { return s.material != scene.spheres.front().material; });
        },
    .declare = [](PlanBuilder& plan) { plan.arrays({Array::ContactParams}); },
};

// Contacts of `accurate` follow Hertz and Mindlin instead of linear springs.
const Module moduleHertz{
    .feature = Feature::Hertz,
    .required =
        [](const scene::Scene& scene, const Features& others) {
            return others.has(Feature::Accurate) &&
                   std::ranges::any_of(scene.materials, [](const scene::Material& m) { return m.young > 0; });
        },
};

// Some contact in the scene has friction, so that spheres turn.
const Module moduleFriction{
    .feature = Feature::Friction,
    .required =
        [](const scene::Scene& scene, const Features& /*others*/) {
            return anyContact(scene, [](const auto& law) { return law.friction > 0; });
        },
    .declare =
        [](PlanBuilder& plan) {
            plan.arrays({Array::AngularVelocity});
            if (!plan.has(Feature::Balanced)) return;
            if (plan.has(Feature::Contacts)) {
                plan.arrays({Array::NormalImpulses});
                plan.overPairs(Stage::Friction, Pass::Friction, "solve_friction.comp");
            }
            if (plan.obstructed()) {
                plan.arrays({Array::WallImpulse});
                plan.overSpheres(Stage::Friction, Pass::WallFriction, "walls_friction.comp");
            }
        },
};

// Some contact in the scene resists rolling or spinning.
const Module moduleRolling{
    .feature = Feature::Rolling,
    .required =
        [](const scene::Scene& scene, const Features& others) {
            return others.has(Feature::Friction) && anyContact(scene, [](const scene::PairLaw& law) {
                       return law.rollingResistance > 0 || law.spinningResistance > 0;
                   });
        },
};

}  // namespace spherule::sim
