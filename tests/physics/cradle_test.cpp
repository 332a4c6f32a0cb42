#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "support.h"

namespace spherule::physics {
namespace {

TEST(Cradle, LastBallLeavesWithTheSpeedOfTheFirst) {
    const auto simulation = simulate(named("cradle"));
    const double speed = velocityOf(simulation->snapshot(), 0).x;
    run(*simulation, 0.5);
    const sim::State state = simulation->snapshot();
    RecordProperty("last", std::to_string(velocityOf(state, 4).x / speed));
    EXPECT_GE(velocityOf(state, 4).x, 0.99 * speed);
    EXPECT_LE(velocityOf(state, 4).x, 1.001 * speed);
    for (std::uint32_t id = 0; id < 4; ++id) EXPECT_LT(glm::length(velocityOf(state, id)), 0.01 * speed) << id;
}

// The velocities after the impact depend on the contact law; docs/accuracy.md describes the result.
TEST(Cradle, TouchingBallsConserveMomentum) {
    const auto simulation = simulate(named("cradle-touching"));
    const sim::State before = simulation->snapshot();
    run(*simulation, 0.5);
    const sim::State after = simulation->snapshot();
    ASSERT_TRUE(allFinite(after));
    EXPECT_LT(glm::length(momentumOf(after) - momentumOf(before)), 1e-5 * momentumScale(before));
    for (std::uint32_t id = 0; id < 5; ++id)
        RecordProperty("speed" + std::to_string(id), std::to_string(velocityOf(after, id).x));
}

}  // namespace
}  // namespace spherule::physics
