#include <gtest/gtest.h>

#include "support.h"

namespace spherule::physics {
namespace {

// Spheres are poured onto obstacles, with contacts, walls, and a rebuild of the lists every few substeps.
std::uint64_t hashAfterHalfASecond(compute::Device& on, std::uint64_t seed) {
    scene::Overrides overrides;
    overrides.seed = seed;
    auto simulation = sim::Simulation::create(on, named("pour", overrides)).value();
    run(*simulation, 0.5);
    EXPECT_GT(simulation->statistics().contacts, 0U);
    EXPECT_GT(simulation->counters().rebuilds, 1U);
    return sim::hashOf(simulation->snapshot());
}

TEST(Determinism, RunsWithTheSameSeedEndInTheSameState) {
    const std::uint64_t first = hashAfterHalfASecond(device(), 1);
    EXPECT_EQ(hashAfterHalfASecond(device(), 1), first);
    EXPECT_EQ(hashAfterHalfASecond(*openTestDevice(), 1), first) << "on a device opened anew";
    EXPECT_NE(hashAfterHalfASecond(device(), 2), first) << "another seed, another world";
}

TEST(Determinism, ResetSceneRepeatsItsRun) {
    const auto simulation = simulate(named("pour"));
    run(*simulation, 0.3);
    const std::uint64_t first = sim::hashOf(simulation->snapshot());
    run(*simulation, 0.2);
    ASSERT_TRUE(simulation->apply(sim::Reset()));
    run(*simulation, 0.3);
    EXPECT_EQ(sim::hashOf(simulation->snapshot()), first);
}

}  // namespace
}  // namespace spherule::physics
