#include "sim/modules/module.h"

namespace spherule::sim {

// The tangential springs of contacts between spheres must survive a rebuild of the lists. During a rebuild, the slip of
// each contact is kept by the id of one of its spheres.
const Module moduleSlipMemory{
    .feature = Feature::SlipMemory,
    .required =
        [](const scene::Scene& /*scene*/, const Features& others) {
            return others.has(Feature::Accurate) && others.has(Feature::Contacts) && others.has(Feature::Friction);
        },
    .declare =
        [](PlanBuilder& plan) {
            using enum Array;
            plan.arrays({TangentialSlip, CarriedOffsets, CarriedSlip});
            plan.onRebuild(Stage::CarrySlip, Pass::SlipMemory, "slip_clear.comp", LAUNCH_OWNERS);
            plan.onRebuild(Stage::CarrySlip, Pass::SlipMemory, "slip_count.comp", LAUNCH_GROUPS);
            plan.prefixSumOnRebuild(Stage::CarrySlip, Pass::SlipMemory, CarriedOffsets,
                                    {LAUNCH_OWNER_BLOCKS, LAUNCH_OWNER_SUPERBLOCKS}, plan.plan().spheres + 1);
            plan.onRebuild(Stage::CarrySlip, Pass::SlipMemory, "slip_carry.comp", LAUNCH_GROUPS);
            plan.onRebuild(Stage::RestoreSlip, Pass::SlipMemory, "slip_restore.comp", LAUNCH_GROUPS);
        },
    .cost = {.reason = "part of friction in `accurate`"},
};

}  // namespace spherule::sim
