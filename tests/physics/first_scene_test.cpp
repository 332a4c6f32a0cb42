#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <string>

#include "scene/catalog.h"
#include "support.h"

namespace spherule::physics {
namespace {

// Speeds and the share of moving spheres, of those that are not fixed.
struct Motion {
    double speedRms = 0;  // m/s
    double moving = 0;    // share that is faster than 5 cm/s
};

// Means over `seconds`, one reading per second.
Motion motionDuring(sim::Simulation& simulation, int seconds) {
    constexpr double slow = 0.05;  // m/s
    Motion mean;
    for (int k = 0; k < seconds; ++k) {
        run(simulation, 1);
        mean.speedRms += simulation.statistics().speedRms / seconds;
        const sim::State state = simulation.snapshot();
        std::size_t free = 0;
        std::size_t moving = 0;
        for (std::uint32_t id = 0; id < state.count(); ++id) {
            if (sim::isFixed(state, id)) continue;
            ++free;
            if (glm::length(sim::velocityOf(state, id)) > slow) ++moving;
        }
        mean.moving += static_cast<double>(moving) / static_cast<double>(free) / seconds;
    }
    return mean;
}

// Visitors see motion first, however late they come.
TEST(FirstScene, StillMovesAfterAMinute) {
    const auto simulation = simulate(named(std::string(scene::defaultScene), {.substeps = 4}));  // half of its own
    run(*simulation, 5);
    const Motion early = motionDuring(*simulation, 5);
    run(*simulation, 45);
    const Motion late = motionDuring(*simulation, 5);
    EXPECT_GT(late.speedRms, 0.5);
    EXPECT_GT(late.moving, 0.9);
    EXPECT_NEAR(late.speedRms / early.speedRms, 1, 0.2) << "it neither comes to rest nor becomes ever faster";
    const sim::Statistics statistics = simulation->statistics();
    EXPECT_EQ(statistics.nonFinite, 0U);
    EXPECT_EQ(statistics.sleeping, 0U);
    RecordProperty("speedRms", std::to_string(late.speedRms));
    RecordProperty("movingPercent", std::to_string(100 * late.moving));
}

}  // namespace
}  // namespace spherule::physics
