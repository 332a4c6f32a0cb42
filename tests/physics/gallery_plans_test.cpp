// Each part of a scene has its own costs: without a part, a plan has no more bytes, passes or launches.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "gallery_removals.h"
#include "gallery_scenes.h"
#include "sim/plan.h"
#include "support.h"

namespace spherule::physics {
namespace {

struct Cost {
    std::uint64_t bytes = 0;
    std::set<sim::Pass> passes;
    std::size_t launches = 0;  // of a substep, of a new length of it, of the end of a step, and of births
    sim::SubstepCost quiet;
    sim::SubstepCost rebuilding;
};

Cost costOf(const scene::Scene& scene, std::uint32_t spheres) {
    const sim::Plan plan = sim::planFor(scene, sim::featuresOf(scene), spheres, sim::radiusStatsOf(scene));
    Cost cost{.bytes = plan.bytes(),
              .passes = {},
              .launches = plan.substep.size() + plan.newSubstep.size() + plan.stepEnd.size() + plan.births.size(),
              .quiet = sim::costOf(plan, false),
              .rebuilding = sim::costOf(plan, true)};
    for (const sim::LaunchSpec& launch : plan.substep) cost.passes.insert(launch.pass);
    return cost;
}

class GalleryPlan : public testing::TestWithParam<std::string> {};

TEST_P(GalleryPlan, WithoutAPartCostsNoMore) {
    const scene::Scene whole = reduced(named(GetParam()), 2'000);
    const auto spheres = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(whole.spheres.size()));
    const Cost with = costOf(whole, spheres);
    for (const Removal& removal : removalsFrom(whole)) {
        scene::Scene part = whole;
        removal.change(part);
        // Samples of emitters are no spheres, and fixed spheres may be gone.
        const auto left = std::max<std::size_t>(1, std::min<std::size_t>(spheres, part.spheres.size()));
        const Cost without = costOf(part, static_cast<std::uint32_t>(left));
        EXPECT_LE(without.bytes, with.bytes) << removal.part;
        EXPECT_LE(without.launches, with.launches) << removal.part;
        std::set<sim::Pass> passes = with.passes;
        // Without lists, there are no rebuilds in which positions are wrapped: each substep does so.
        if (removal.part == "contacts" && whole.bounds.anyPeriodic()) passes.insert(sim::Pass::Integrate);
        EXPECT_TRUE(std::ranges::includes(passes, without.passes)) << removal.part;
        for (const auto cost : {&Cost::quiet, &Cost::rebuilding}) {
            EXPECT_LE((without.*cost).launches, (with.*cost).launches) << removal.part;
            EXPECT_LE((without.*cost).barriers, (with.*cost).barriers) << removal.part;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Of, GalleryPlan, testing::ValuesIn(galleryScenes()), testNameOf);

}  // namespace
}  // namespace spherule::physics
