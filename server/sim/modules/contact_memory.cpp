#include "sim/modules/module.h"

namespace spherule::sim {

// The memory of contacts between spheres, from one substep to the next. It must survive a rebuild of the lists.
// `balanced` remembers the impulse, `accurate` the tangential displacement.
const Module moduleContactMemory{
    .feature = Feature::ContactMemory,
    .required =
        [](const scene::Scene& /*scene*/, const Features& others) {
            return others.has(Feature::Contacts) &&
                   (others.has(Feature::Balanced) || (others.has(Feature::Accurate) && others.has(Feature::Friction)));
        },
    .declare =
        [](PlanBuilder& plan) {
            using enum Array;
            plan.arrays({ContactX, ContactY, ContactZ, CarriedCount, Carried});
            if (plan.has(Feature::Balanced) && plan.has(Feature::Friction)) plan.arrays({TorqueX, TorqueY, TorqueZ});
            if (plan.has(Feature::Movers))
                plan.onRebuild(Stage::Carry, Pass::ContactMemory, "contacts_carry.comp", LAUNCH_FORGET, {}, 0);
            plan.onRebuild(Stage::Carry, Pass::ContactMemory, "contacts_carry.comp", LAUNCH_BUNDLES, {}, 1);
            plan.onRebuild(Stage::Restore, Pass::ContactMemory, "contacts_restore.comp", LAUNCH_BUNDLES);
            if (!plan.has(Feature::Balanced)) return;
            // If the new lists lack a contact, its impulse is no longer among the impulses that its spheres hold.
            plan.onRebuild(Stage::Restore, Pass::ContactMemory, "contacts_lost.comp", LAUNCH_ONE);
            plan.onRebuild(Stage::Restore, Pass::ContactMemory, "held_by_walls.comp", LAUNCH_LOST_SPHERES);
            plan.overPairsIf(Stage::Restore, Pass::ContactMemory, "held_by_pairs.comp", LAUNCH_LOST_COLOUR);
        },
    .cost = {.reason = "part of `balanced`, and of friction in `accurate`"},
};

}  // namespace spherule::sim
